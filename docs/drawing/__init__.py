"""The picture of the architecture, drawn from the imports. `python -m docs.drawing` writes it, `--check` compares."""
