"""Valid configurations: where a singularity may go, and the way to where it does."""
