"""Many members of one scene, which differ in numbers alone, answered together to the bit as each by itself."""
