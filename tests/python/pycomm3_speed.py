"""Reads D0000 ... with pycomm3 (MIT) as often as it can and prints, as JSON, what that came to.

    python pycomm3_speed.py 127.0.0.1:44818 COUNT WARM_UP_MS MEASURE_MS
"""

import json
import sys
import time

from pycomm3 import LogixDriver


class Counted(LogixDriver):
    """Counts its messages."""

    messages = 0

    def send(self, request):
        self.messages += 1
        return super().send(request)


def main(address, count, warm_up, measure):
    names = [f"D{number:04}" for number in range(count)]
    with Counted(address, init_program_tags=False) as plc:

        def cycle():
            tags = plc.read(*names)
            assert len(tags) == count and not any(tag.error for tag in tags)

        end = time.monotonic() + warm_up / 1000
        cycle()
        while time.monotonic() < end:
            cycle()
        plc.messages, cycles = 0, 0
        begun, used = time.monotonic(), time.process_time()
        while time.monotonic() - begun < measure / 1000:
            cycle()
            cycles += 1
        seconds, used = time.monotonic() - begun, time.process_time() - used
        print(
            json.dumps(
                {
                    "requests_per_cycle": plc.messages / cycles,
                    "values_per_second": cycles * count / seconds,
                    "cpu": used * 1e6 / (cycles * count),
                }
            )
        )


if __name__ == "__main__":
    main(sys.argv[1], *map(int, sys.argv[2:5]))
