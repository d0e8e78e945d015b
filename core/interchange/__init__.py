"""Scenes as files of other programs: URDF, MJCF and SDF read, MJCF and Modelica written."""
