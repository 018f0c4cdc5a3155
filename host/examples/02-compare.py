#!/usr/bin/python3
"""Error over floor on a record that the model has not seen: about 1 for a perfect model."""
import sys

import axistool

drive = sys.argv[1] if len(sys.argv) > 1 else "/usr/share/axistool/drive"
print("error over floor =", axistool.compare(f"{drive}/model.toml", f"{drive}/validate.csv").combined)
