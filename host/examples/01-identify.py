#!/usr/bin/python3
"""Inertia from a record of steps."""
import sys

import axistool

drive = sys.argv[1] if len(sys.argv) > 1 else "/usr/share/axistool/drive"
found = axistool.identify(f"{drive}/train-steps.csv", drive=f"{drive}/model.toml")
print("J =", found.parameters["J_kg_m2"].value)
