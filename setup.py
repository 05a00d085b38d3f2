"""What pyproject.toml cannot say: a wheel holds the built page, so that whoever installs it needs no Node."""

from __future__ import annotations

import shutil
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

BUILT = Path(__file__).parent / "frontend" / "dist"


class WithPage(build_py):
    """The page goes where `backend.settings` looks for it; without one the server says how to build it."""

    def run(self) -> None:
        """As always, then the page."""
        super().run()
        if BUILT.is_dir() and not self.editable_mode:
            target = Path(self.build_lib) / "backend" / "page"
            shutil.rmtree(target, ignore_errors=True)
            shutil.copytree(BUILT, target, ignore=shutil.ignore_patterns(".*"))


setup(cmdclass={"build_py": WithPage})
