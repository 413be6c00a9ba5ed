"""`python -m kerf_cam`: the command `kerf`, also where another module is named `kerf`."""

from kerf_cam import main

main()
