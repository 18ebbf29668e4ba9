"""python_files.py FOLDER: the files of the modules that the sources in FOLDER import and that Python itself does
not have, a line each, for the dependencies of the package. Fails where one of them is not installed."""

import ast
import importlib.util
import sys
from pathlib import Path

names = set()
for source in Path(sys.argv[1]).glob("*.py"):
    for node in ast.walk(ast.parse(source.read_text())):
        if isinstance(node, ast.Import):
            names |= {alias.name.split(".")[0] for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.level == 0:
            names.add(node.module.split(".")[0])
for name in sorted(names - sys.stdlib_module_names):
    found = importlib.util.find_spec(name)
    if found is None:
        sys.exit(f"python_files.py: {name} is not installed")
    print(found.origin)
