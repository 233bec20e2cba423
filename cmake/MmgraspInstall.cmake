# Placeholder replaced by the packaging work: install rules and package config for find_package(mmgrasp).
