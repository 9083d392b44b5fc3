"""Reads and writes the simulated Logix with pylogix (Apache-2.0); its expected output is in pylogix_logix.txt.

    python pylogix_logix.py 127.0.0.1:44818
"""

import sys

from pylogix import PLC


def show(answers):
    for answer in answers if isinstance(answers, list) else [answers]:
        print(answer.TagName, "=", repr(answer.Value), answer.Status)


def main(address):
    host, port = address.split(":")
    with PLC(host) as plc:
        plc.Port = int(port)

        print("-- scalars")
        for tag in ["Scalar", "Setpoint", "Enabled", "Small", "Large", "Double", "Recipe", "Program:Main.x"]:
            show(plc.Read(tag))
        show(plc.Write("Scalar", -7))
        show(plc.Write("Setpoint", 2.5))
        show(plc.Write("Recipe", "Quick"))
        show(plc.Read(["Scalar", "Setpoint", "Enabled", "Recipe", "Motor1.Count"]))
        show(plc.Write([("Scalar", 1), ("Setpoint", 3.5), ("Motor1.Count", 9)]))
        show(plc.Read(["Scalar", "Setpoint", "Motor1.Count"]))

        print("-- arrays")
        show(plc.Read("Arr", 10))
        show(plc.Write("Arr[2]", [102, 103, 104]))
        show(plc.Read("Arr[1]", 5))
        show(plc.Read("Matrix[1,2]"))
        show(plc.Read("Names[0]", 4))
        big = plc.Read("Big[0]", 3000)
        print("Big", len(big.Value), big.Status)

        print("-- bits")
        show(plc.Write("Flags[37]", True))
        show(plc.Read("Flags[36]", 3))
        show(plc.Write("Status.4", True))
        show(plc.Read("Status"))
        show(plc.Read("Status.4"))

        print("-- a structure")
        motor = plc.Read("Motor1")
        print("Motor1", len(motor.Value), "bytes", motor.Status)
        show(plc.Read(["Motor1.Speed", "Motor1.Run", "Motor1.Hist[2]", "Motor1.Name"]))

        print("-- refusals")
        show(plc.Read("Nobody"))
        show(plc.Read("Arr[100]"))
        show(plc.Write("Limit", 1))

        print("-- tag list")
        tags = plc.GetTagList()
        print(tags.Status, plc.ProgramNames)
        for tag in tags.Value:
            if not tag.TagName.startswith("D0"):
                print(tag.TagName, tag.DataType, tag.Size or "")
        print("numbered", len([tag for tag in tags.Value if tag.TagName.startswith("D0")]))

        print("-- structures")
        for name, kind in sorted(plc.UDTByName.items()):
            print(name + ":", ", ".join(f"{field.TagName} {field.DataType}" for field in kind.Fields))


main(sys.argv[1])
