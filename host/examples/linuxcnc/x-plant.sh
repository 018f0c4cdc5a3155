#!/bin/sh
# Joint x: the simulator's drive of this model.
exec axistool sim --as-plant --axes 1 --x x-machine.toml
