"""Tests; they mirror the code file for file, but for what `test_architecture` lists."""
