"""Prints the digests that log_hash_test.cpp expects: the layout written at LogHash, a second time.

    python3 tests/tasks/log_hash_vector.py
"""
import hashlib
import struct


def text(value: str) -> bytes:
    data = value.encode()
    return struct.pack("<Q", len(data)) + data


def whole(*streams: bytes) -> str:
    parts = b"".join(hashlib.sha256(stream).digest() for stream in streams)
    return hashlib.sha256(b"trocar log 1\n" + parts).hexdigest()


NAN = bytes.fromhex("000000000000f87f")

setup = b"".join(map(text, [
    "touch-points", 'id = "touch-points"\n# with "quotes" and \u00fc\n',
    '[scene]\nname = "abdomen"\n', "5ce4e", "corotated", "anchored"]))
setup += struct.pack("<QiB", 0xFEDCBA9876543210, 100, 1)
setup += struct.pack("<Q9q", 3, 1, -2, 3, 4, 5, -6, 10**12, 0, -1)

ticks = b""
for tick in (5, 6):
    ticks += struct.pack("<qq", tick, tick - 6)
    for tool in range(3):
        ticks += struct.pack("<5iB", 100 * tool + tick, -tool, 2**31 - 1, 7, -8, [2, 4, 6][tool])

steps = struct.pack("<qqB", 3, 4, 1) + struct.pack("<qqB", 4, 14, 0)

events = struct.pack("<qBbb4d", 1234, 2, 1, -1, 0.01, -0.25, 0.0, 2.5)
events += struct.pack("<qBbb3d", 1300, 10, -1, -1, 1.0, 2.0, 3.0) + NAN

metrics = text("path_length.left") + struct.pack("<id", 2, 0.1) + text("m")
metrics += struct.pack("<BBqq", 1, 0, 10, 999)

print("empty", whole(b"", b"", b"", b"", b""))
print("full ", whole(setup, ticks, steps, events, metrics))
one = struct.pack("<qq", 5, -1)
for tool in range(3):
    one += struct.pack("<5iB", 100 * tool + 5, -tool, 2**31 - 1, 7, -8, [2, 4, 6][tool])
one += struct.pack("<5iB", 1, -2, 3, 4, -5, 2 | 8)
two = ticks[len(ticks) // 2:]
print("scope", whole(setup, one + two, steps, events, metrics))
