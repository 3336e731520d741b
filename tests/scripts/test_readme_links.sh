#!/usr/bin/env bash
# Links between the pages of this project lead to files and headings that are there.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."
python3 -B - <<'PYTHON'
import os, re, sys


def anchors(text):
    """The headings as links name them: lower case, blanks as hyphens, other marks left out."""
    return {re.sub(r"[^\w\- ]", "", heading.lower()).strip().replace(" ", "-")
            for heading in re.findall(r"(?m)^#+ (.*)$", text)}


def read(name):
    with open(name, encoding="utf-8") as file:
        return file.read()


pages = []
for folder, folders, names in os.walk("."):
    folders[:] = [name for name in folders if name not in ("build", ".git")]
    pages += [os.path.join(folder, name) for name in names if name.endswith(".md")]
links, faults = 0, []
for page in sorted(pages):
    for target, anchor in re.findall(r"\]\(([^)#\s]*)(?:#([^)\s]+))?\)", read(page)):
        if re.match(r"\w+:", target):
            continue
        links += 1
        path = os.path.normpath(os.path.join(os.path.dirname(page), target)) if target else page
        if not os.path.exists(path):
            faults.append(f"{page}: there is no {target}")
        elif anchor and path.endswith(".md") and anchor not in anchors(read(path)):
            faults.append(f"{page}: {target or page} has no heading #{anchor}")
for fault in faults:
    print(fault, file=sys.stderr)
if links < 50:
    sys.exit(f"only {links} links were found")
sys.exit(1 if faults else 0)
PYTHON
