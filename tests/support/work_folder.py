"""Where a script of the tests may write: never into the source tree."""
import os
import pathlib

SOURCE = pathlib.Path(os.environ.get("BARCHAN_SOURCE", pathlib.Path(__file__).resolve().parents[2])).resolve()


def leave_tree(name):
    """Started in the source tree, as by hand, a script goes on in build/by-hand/NAME."""
    here = pathlib.Path.cwd().resolve()
    if here.is_relative_to(SOURCE) and not here.is_relative_to(SOURCE / "build"):
        folder = SOURCE / "build" / "by-hand" / name
        folder.mkdir(parents=True, exist_ok=True)
        os.chdir(folder)
