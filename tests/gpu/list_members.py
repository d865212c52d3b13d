#!/usr/bin/env python3
"""list_members.py SHARED_H OUTPUT: every struct of shaders/shared.h and its members as macro calls,
STRUCT(name) MEMBER(name, member)… END(name), for test_gpu_layout.c."""
import re
import sys

with open(sys.argv[1], encoding="utf-8") as file:
    text = re.sub(r"/\*.*?\*/|//[^\n]*", "", file.read(), flags=re.S)
structs = re.findall(r"^TURNER_STRUCT\((\w+)\)\s*\{(.*?)\};", text, flags=re.S | re.M)
assert structs, "no struct found"
with open(sys.argv[2], "w", encoding="utf-8") as file:
    for struct, body in structs:
        file.write(f"STRUCT({struct})\n")
        for declaration in body.split(";"):
            # TURNER_VEC3(name) or type name[n]
            match = re.fullmatch(r"\s*(?:TURNER_\w+\s*\((\w+)\)|\w+\s+(\w+)|TURNER_UINT64\s+(\w+))"
                                 r"\s*(?:\[\w+\])?\s*", declaration)
            if match:
                file.write(f"MEMBER({struct}, {match[1] or match[2] or match[3]})\n")
            else:
                assert not declaration.strip(), f"{struct}: cannot read {declaration!r}"
        file.write(f"END({struct})\n")
