"""What a file says of its Cryptomattes, so that they can be picked by name. Rests on: Psyop, "Cryptomatte Specification"
1.1.0; Austin Appleby's MurmurHash3, 32 bits."""

import json

_MASK = 0xFFFFFFFF


def _rotated(word, bits):
    return (word << bits | word >> (32 - bits)) & _MASK


def _murmur3(data):
    found = 0
    for at in range(0, len(data), 4):
        word = int.from_bytes(data[at:at + 4], "little")
        found ^= _rotated(word * 0xCC9E2D51 & _MASK, 15) * 0x1B873593 & _MASK
        if at + 4 <= len(data):
            found = (_rotated(found, 13) * 5 + 0xE6546B64) & _MASK
    found ^= len(data)
    for shift, factor in ((16, 0x85EBCA6B), (13, 0xC2B2AE35), (16, 1)):
        found = (found ^ found >> shift) * factor & _MASK
    return found


def hash_of(name):
    """The id of a name: the bits of a float that is neither denormal nor infinite nor no number."""
    found = _murmur3(name.encode())
    return found ^ 1 << 23 if found >> 23 & 255 in (0, 255) else found


def metadata(layer_name, kind, names):
    """Fields and values. layer_name: "ViewLayer"; kind: "object" or "material"."""
    name = f"{layer_name}.Crypto{kind.title()}"
    manifest = json.dumps({each: f"{hash_of(each):08x}" for each in sorted(names)}, separators=(",", ":"))
    values = {"name": name, "hash": "MurmurHash3_32", "conversion": "uint32_to_float32", "manifest": manifest}
    prefix = f"cryptomatte/{_murmur3(name.encode()):08x}"[:len("cryptomatte/") + 7]
    return {f"{prefix}/{field}": value for field, value in values.items()}
