"""Records what LinuxCNC's interpreter does with random programs:
python3 record_interpreter.py > ../data/gcode/recorded.txt
A change of random_gcode.py does not change the record: the programs are in it."""
import random_gcode
import rs274

SEEDS = range(1000, 1014)

print("""\
# Programs of random_gcode.py and the moves that LinuxCNC's interpreter (rs274 2.9) makes of them, for
# machines without it; written by record_interpreter.py. The notation is that of moves.txt; "!": the program
# is refused.""")
for name, make in random_gcode.FAMILIES.items():
    if name == "checksums":
        continue  # not words of LinuxCNC
    for seed in SEEDS:
        text = make(seed)
        moves, refused = rs274.moves_of(text)
        print(f"\nprogram {name} {seed}")
        print(text.strip().replace("\n", "|"))
        print("!" if refused else "= " + "; ".join(
            f"D {rs274.number(m[1])}" if m[0] == "D" else rs274.written(m) for m in moves))
