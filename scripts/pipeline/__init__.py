"""What all stages share at the rim: tables, axes of the config, labels of starts, logs."""
