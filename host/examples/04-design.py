#!/usr/bin/python3
"""Estimator and state feedback from a model, with the loop at 25 Hz: its gain on the position error."""
import sys

import axistool

drive = sys.argv[1] if len(sys.argv) > 1 else "/usr/share/axistool/drive"
print("K1 =", axistool.design(f"{drive}/model.toml", fc=25).Kc[0])
