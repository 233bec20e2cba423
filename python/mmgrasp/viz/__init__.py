"""Pictures, the report page and the browser viewer of a finished plan. Everything here reads the plan file alone."""
