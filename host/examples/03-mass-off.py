#!/usr/bin/python3
"""Inertia 20 % too high: shows where the prediction fails."""
import sys

import axistool

drive = sys.argv[1] if len(sys.argv) > 1 else "/usr/share/axistool/drive"
model = axistool.Model.read(f"{drive}/model.toml")
for effect in model.document["effect"]:
    if effect["kind"] == "inertia":
        effect["J_kg_m2"] *= 1.2
print(axistool.compare(model, f"{drive}/train-steps.csv").json["where_in_words"])
