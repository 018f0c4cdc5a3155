#!/bin/sh
# Joint x: simulates the drive of this model.
exec axistool sim --as-plant --axes 1 --x x-machine.toml
