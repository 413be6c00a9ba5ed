; firmware: klipper
G28
G1 X10 Y10 Z0.2 F1200
G1 X50 E2.5 F900
