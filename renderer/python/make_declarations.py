"""Reads the preprocessed public headers and writes the module's declarations: enumerations, structures, callbacks and
functions, for ctypes. What it does not understand is an error, so that nothing of the headers is left out.
Use: cc -E -P -x c afterglow.h >afterglow.i; make_declarations.py afterglow.i _declarations.py"""

import re
import sys

API = r'__attribute__\(\(visibility\("default"\)\)\)'
NUMBERS = {"_Bool": "c_bool", "char": "c_char", "unsigned char": "c_ubyte", "int": "c_int", "unsigned": "c_uint",
           "unsigned int": "c_uint", "int32_t": "c_int32", "uint32_t": "c_uint32", "int64_t": "c_int64",
           "uint64_t": "c_uint64", "size_t": "c_size_t", "float": "c_float", "double": "c_double"}
HEAD = '''"""What the library's headers declare, by ctypes; written by make_declarations.py. Addresses of arrays that are only read
are void pointers, those of results are typed."""

import enum
from ctypes import (CFUNCTYPE, POINTER, Structure, c_bool, c_char, c_char_p, c_double, c_float, c_int, c_int32, c_int64,
                    c_size_t, c_ubyte, c_uint, c_uint32, c_uint64, c_void_p)
'''


class Unknown(Exception):
    """A declaration that is not understood."""


def class_name(name):
    """ag_scene_settings: SceneSettings."""
    return "".join(word.capitalize() for word in name[len("ag_"):].split("_"))


def split_declaration(text):
    """A declaration's type, without the stars, its number of stars, its name and the lengths of an array:
    "const float up[3]" gives ("const float", 0, "up", ["3"])."""
    found = re.fullmatch(r"\s*((?:const )?(?:unsigned char|unsigned int|\w+))((?:[\s*]|\bconst\b)*)(\w*)((?:\[[^\]]*\])*)\s*", text)
    if not found:
        raise Unknown(text)
    return found.group(1), found.group(2).count("*"), found.group(3), re.findall(r"\[([^\]]*)\]", found.group(4))


class Headers:
    """The declarations of a text."""

    def __init__(self, text):
        self.text = re.sub(r"\s+", " ", text)
        self.values = {}  # of enumerators
        self.enums = dict(self._bodies("enum"))
        self.structs = dict(self._bodies("struct"))
        self.opaque = set(re.findall(r"typedef struct (ag_\w+) \1;", self.text)) - set(self.structs)
        self.aliases = {name: kind for kind, name in re.findall(r"typedef (\w+) (ag_\w+);", self.text)}
        self.callbacks = {name: (result, arguments) for result, name, arguments in re.findall(
            r"typedef ([^;{}()]*?)(ag_\w+)\(([^;]*?)\);", self.text)}
        self.functions = {name: (result, arguments) for result, name, arguments in re.findall(
            API + r" ([^;{}()]*?)(ag_\w+)\(([^;{}]*?)\);", self.text)}
        if len(self.functions) != len(re.findall(API, self.text)):
            raise Unknown("a function that is exported")
        known = self.enums.keys() | self.structs.keys() | self.opaque | self.aliases.keys() | self.callbacks.keys()
        for name in re.findall(r"\btypedef [^;{]*?\b(ag_\w+)", self.text):
            if name not in known:
                raise Unknown(f"typedef of {name}")

    def _bodies(self, kind):
        found = re.findall(rf"typedef {kind} (ag_\w+) \{{([^{{}}]*)\}} \1;", self.text)
        if len(found) != len(re.findall(rf"\b{kind} ag_\w+ \{{", self.text)):
            raise Unknown(f"a {kind} that is not typedef {kind} NAME {{ ... }} NAME;")
        return found

    def type_of(self, base, stars, is_result=False, is_array=False):
        """The ctypes expression of a C type."""
        is_constant = base.startswith("const ")
        name = base.replace("const ", "")
        name = self.aliases.get(name, name)
        stars += is_array
        if name in self.callbacks and stars == 1:
            return class_name(name)
        if name == "void" and stars == 0:
            return "None"
        if stars == 0 and name in self.enums:
            return "c_int"
        if stars == 0 and name in NUMBERS:
            return NUMBERS[name]
        if stars == 0 and name in self.structs:
            return class_name(name)
        if name == "char" and is_constant and stars in (1, 2):
            return "c_char_p" if stars == 1 else "POINTER(c_char_p)"
        if name in self.structs and stars == 1:
            return f"POINTER({class_name(name)})"
        if name in self.opaque or name in ("void", "char") or name in self.structs:
            if stars in (1, 2):
                return "c_void_p" if stars == 1 else "POINTER(c_void_p)"
        elif (name in NUMBERS or name in self.enums) and stars == 1:
            number = NUMBERS.get(name, "c_int")
            return "c_void_p" if is_constant and not is_result else f"POINTER({number})"
        raise Unknown(f"{base} {'*' * stars}")

    def arguments(self, text):
        if text.strip() == "void":
            return []
        made = []
        for each in text.split(","):
            base, stars, _, lengths = split_declaration(each)
            made.append(self.type_of(base, stars, is_array=bool(lengths)))
        return made

    def result(self, text):
        base, stars, _, _ = split_declaration(text.strip() + " result")
        return self.type_of(base, stars, is_result=True)

    def enumeration(self, name, body):
        """Its members by name, without the words that all of them begin with."""
        members, after = {}, 0
        for each in filter(None, (part.strip() for part in body.split(","))):
            member, _, expression = (part.strip() for part in each.partition("="))
            value = eval(expression, {"__builtins__": {}}, self.values) if expression else after
            members[member] = self.values[member] = value
            after = value + 1
        words = [member.split("_") for member in members]
        shared = 0
        while all(len(each) > shared + 1 and each[shared] == words[0][shared] for each in words):
            shared += 1
        if len(members) == 1 or not all("_".join(each[shared:]).isidentifier() for each in words):
            shared = 1
        return {"_".join(member.split("_")[shared:]): value for member, value in members.items()}

    def fields(self, body):
        for declaration in filter(None, (part.strip() for part in body.split(";"))):
            first, *others = declaration.split(",")
            base = split_declaration(first)[0]
            for each in (first, *(f"{base} {other.strip()}" for other in others)):
                base, stars, field, lengths = split_declaration(each)
                if not field:
                    raise Unknown(declaration)
                kind = self.type_of(base, stars)
                for length in reversed(lengths):
                    kind += f" * {eval(length, {'__builtins__': {}}, self.values)}"
                yield field, kind

    def lines(self):
        yield HEAD
        for name, body in self.enums.items():
            yield f"\nclass {class_name(name)}(enum.IntEnum):"
            yield from (f"    {member} = {value}" for member, value in self.enumeration(name, body).items())
            yield ""
        yield ""
        for name, (result, arguments) in self.callbacks.items():
            yield f"{class_name(name)} = CFUNCTYPE({', '.join([self.result(result), *self.arguments(arguments)])})"
        yield ""
        for name, body in self.structs.items():
            yield f"\nclass {class_name(name)}(Structure):\n    _fields_ = ["
            yield from (f'        ("{field}", {kind}),' for field, kind in self.fields(body))
            yield "    ]\n"
        yield "\nSTRUCTURES = {"
        yield from (f'    "{name}": {class_name(name)},' for name in self.structs)
        yield "}\nENUMERATIONS = {"
        yield from (f'    "{name}": {class_name(name)},' for name in self.enums)
        yield "}\nFUNCTIONS = {  # result and arguments"
        for name, (result, arguments) in self.functions.items():
            yield f'    "{name}": ({self.result(result)}, [{", ".join(self.arguments(arguments))}]),'
        yield "}"


if __name__ == "__main__":
    with open(sys.argv[1], encoding="utf-8") as headers:
        try:
            written = "\n".join(Headers(headers.read()).lines()) + "\n"
        except Unknown as what:
            sys.exit(f"{sys.argv[1]}: not understood: {what}")
    with open(sys.argv[2], "w", encoding="utf-8") as out:
        out.write(written)
