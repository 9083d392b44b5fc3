"""Reads and writes the simulated NX with aphyt; see aphyt_omron.txt. Its port is fixed: 44818.

    python aphyt_omron.py 127.0.0.2
"""

import sys

from aphyt import omron
from aphyt.cip.cip import CIPException


def show(plc, name):
    print(name, "=", plc.read_variable(name))


def write(plc, name, value):
    plc.write_variable(name, value)
    print(name, "<-", value)


def refused(what, action):
    try:
        action()
    except CIPException as error:
        words = bytes(reversed(error.extended_status)).hex() if error.extended_status else ""
        print(what, "refused", error.status.hex(), words)
    else:
        print(what, "was not refused")


def main(host):
    with omron.n_series.NSeries(host) as plc:
        print("-- variables")
        plc.update_variable_dictionary()
        print("user", len(plc.user_variable_list()), "system", plc.system_variable_list())
        print(" ".join(plc.user_variable_list()))

        print("-- values")
        for name in ["TAG1", "TAG2", "grHWCs_SP", "gsRecipe", "gcVersion", "elSint", "elInt", "elDint", "elLint"]:
            show(plc, name)
        for name in ["elUsint", "elUint", "elUdint", "elUlint", "elLreal", "elMode", "elByte", "elLword", "elDateTime"]:
            show(plc, name)
        for name, value in [("TAG1", False), ("grHWCs_SP", 12.5), ("elDint", -7), ("gsRecipe", "Grüße"), ("elMode", 2)]:
            write(plc, name, value)
            show(plc, name)

        print("-- arrays")
        for name in ["arSet", "arBool", "arTable", "arFrom1", "arNames"]:
            show(plc, name)
        write(plc, "arSet", [1, 2, 3, 4, 5, 6, 7, 8, 9, 10])
        show(plc, "arSet")
        write(plc, "arNames", ["a", "b", "c", "d"])
        show(plc, "arNames")
        plc.write_variable("arLong", list(range(400)))
        print("arLong", plc.read_variable("arLong").value() == list(range(400)))

        print("-- structures")
        for name in ["stSet", "stLine"]:
            show(plc, name)
        motor = plc.read_variable("stSet")
        motor["speed"] = 99.5
        motor["run"] = True
        plc.write_variable("stSet", motor)
        show(plc, "stSet")

        print("-- refusals")
        refused("a missing variable", lambda: plc.read_variable("nobody"))
        refused("a hidden variable", lambda: plc.read_variable("gnHidden"))
        refused("a constant", lambda: plc.write_variable("gcLimit", 1))
        refused("a value outside", lambda: plc.write_variable("gnPercent", 101))


main(sys.argv[1])
