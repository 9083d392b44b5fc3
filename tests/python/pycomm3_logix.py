"""Reads and writes the simulated Logix with pycomm3 (MIT): scalars, Arr{10}, a structure, STRINGs, the tag list.

What it prints is compared with pycomm3_logix.txt. Values that move are not printed.

    python pycomm3_logix.py 127.0.0.1:44818
"""

import sys

from pycomm3 import LogixDriver


def show(tag):
    print(f"{tag.tag} = {tag.value!r} {tag.type}" + (f" ERROR {tag.error}" if tag.error else ""))


def main(address):
    with LogixDriver(address) as plc:
        print("project", plc.info["name"], "/", plc.info["product_name"], plc.info["revision"])
        print("programs", sorted(plc.info["programs"]))

        print("-- scalars")
        for tag in plc.read("Scalar", "Setpoint", "Enabled", "Small", "Middle", "Large", "Recipe", "Program:Main.x"):
            show(tag)
        show(plc.read("Double"))
        for tag in plc.write(("Scalar", 43), ("Setpoint", -1.5), ("Enabled", False), ("Small", 7), ("Program:Main.x", 8)):
            show(tag)
        for tag in plc.read("Scalar", "Setpoint", "Enabled", "Small", "Program:Main.x"):
            show(tag)

        print("-- arrays")
        show(plc.read("Arr{10}"))
        show(plc.read("Arr[5]{3}"))
        show(plc.write("Arr[2]{3}", [102, 103, 104]))
        show(plc.read("Arr{10}"))
        show(plc.read("Matrix[1,2]"))
        show(plc.read("Matrix{12}"))
        show(plc.read("Names{4}"))

        print("-- what does not fit into one packet")
        show(plc.write("Big{3000}", list(range(3000)))._replace(value="0..2999"))
        big = plc.read("Big{3000}")
        print("Big", big.type, big.value == list(range(3000)), big.error)

        print("-- BOOLs")
        show(plc.write("Flags[32]{32}", [index % 3 == 0 for index in range(32)]))
        show(plc.read("Flags{64}"))
        show(plc.read("Flags[35]"))

        print("-- bits")
        show(plc.write("Status.4", True))
        show(plc.write("Status.0", False))
        show(plc.read("Status"))
        show(plc.read("Status.4"))

        print("-- STRINGs")
        show(plc.write("Recipe", "Grüße"))
        show(plc.read("Recipe"))
        show(plc.write("Names[1]", "elsewhere"))
        show(plc.read("Names{4}"))

        print("-- a structure")
        motor = plc.read("Motor1")
        show(motor)
        changed = {**motor.value, "Speed": 12.5, "Run": False, "Fault": True, "Hist": [9, 8, 7, 6], "Name": "Pump 2"}
        show(plc.write("Motor1", changed))
        show(plc.read("Motor1"))
        for tag in plc.read("Motor1.Speed", "Motor1.Fault", "Motor1.Hist[2]", "Motor1.Name"):
            show(tag)
        show(plc.write("Motor1.Ready", False))
        show(plc.read("Motor1.Ready"))
        show(plc.read("Line1"))

        print("-- refusals")
        show(plc.write("Limit", 1))
        show(plc.read("Arr[100]"))
        show(plc.read("Hidden"))

        print("-- tag list")
        for name, tag in plc.tags.items():
            if name.startswith("D0"):
                continue
            dimensions = [length for length in tag["dimensions"] if length]
            print(name, tag["data_type_name"], dimensions or "", tag["external_access"])
        print("numbered", len([name for name in plc.tags if name.startswith("D0")]))

        print("-- structures")
        for name, kind in sorted(plc.data_types.items()):
            members = ", ".join(f"{member}: {kind['internal_tags'][member]['data_type_name']}" for member in kind["attributes"])
            print(name, kind["template"]["structure_size"], "bytes:", members)


main(sys.argv[1])
