"""YAML and JSON files as nodes that know file, line and key, so that every message names them."""
