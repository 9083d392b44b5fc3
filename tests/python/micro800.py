"""Reads and writes the simulated Micro800 with pycomm3 (MIT) and pylogix (Apache-2.0); see micro800.txt.

    python micro800.py 127.0.0.1:44818
"""

import sys

from pycomm3 import LogixDriver
from pylogix import PLC


def with_pycomm3(address):
    print("== pycomm3")
    with LogixDriver(address) as plc:
        print(plc.info["product_name"], "micro800:", plc._micro800)
        for tag in plc.read("Scalar", "Setpoint", "Enabled", "Small", "Word32", "Recipe", "_IO_EM_DO_00"):
            print(tag.tag, "=", repr(tag.value), tag.type, tag.error or "")
        for tag in plc.write(("Scalar", 43), ("Setpoint", -1.5), ("Enabled", False), ("Recipe", "Quick")):
            print(tag.tag, "<-", repr(tag.value), tag.error or "")
        for tag in plc.read("Scalar", "Setpoint", "Enabled", "Recipe"):
            print(tag.tag, "=", repr(tag.value), tag.type, tag.error or "")
        tag = plc.write("Arr[2]{3}", [102, 103, 104])
        print(tag.tag, "<-", tag.value, tag.error or "")
        tag = plc.read("Arr{10}")
        print(tag.tag, "=", tag.value, tag.type, tag.error or "")
        print("tags:", " ".join(plc.tags))


def with_pylogix(address):
    print("== pylogix")
    host, port = address.split(":")
    with PLC(host) as plc:
        plc.Port = int(port)
        plc.Micro800 = True
        for answer in plc.Read(["Scalar", "Setpoint", "Enabled", "Recipe"]):
            print(answer.TagName, "=", repr(answer.Value), answer.Status)
        for name, value in [("Scalar", 44), ("Recipe", "Slow"), ("Arr[0]", [5, 6, 7])]:
            answer = plc.Write(name, value)
            print(answer.TagName, "<-", repr(value), answer.Status)
        for answer in [plc.Read("Scalar"), plc.Read("Recipe"), plc.Read("Arr", 5), plc.Read("Nobody"), plc.Write("Limit", 1)]:
            print(answer.TagName, "=", repr(answer.Value), answer.Status)


with_pycomm3(sys.argv[1])
with_pylogix(sys.argv[1])
