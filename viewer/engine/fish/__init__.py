"""Fish: how they swim, paddle and flock."""
