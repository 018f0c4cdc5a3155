#!/usr/bin/python3
"""Error over noise floor on a held-back record: about 1 for a perfect model."""
import sys

import axistool

drive = sys.argv[1] if len(sys.argv) > 1 else "/usr/share/axistool/drive"
print("error over floor =", axistool.compare(f"{drive}/model.toml", f"{drive}/validate.csv").combined)
