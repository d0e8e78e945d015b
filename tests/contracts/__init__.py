"""What every member of a catalogue must obey, run over all members."""
