"""`python -m kerf`: the command `kerf`."""

from kerf_cam import main

main()
