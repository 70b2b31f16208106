#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""Check the sizes that docs/contributing.md promises: of lines, functions and files.

    limits.py SOURCE_FOLDER

prints each place beyond a limit, and exits with 1 if there is one. It knows a C++ function by its
braces, a shell function by its head and a `}` in the first column, and Python by its parser,
without the text that documents it.
"""
import ast
import re
import sys
from pathlib import Path

LINE_WIDTH = 100
FUNCTION_LINES = 60
FILE_LINES = 400

FOLDERS = [".ci", "include", "job_scripts", "src", "tests"]
CPP, CMAKE, SHELL, PYTHON = "C++", "CMake", "shell", "Python"
LANGUAGES = {".hpp": CPP, ".cpp": CPP, ".h": CPP, ".c": CPP, ".cmake": CMAKE, ".py": PYTHON,
             ".sh": SHELL, ".sbatch": SHELL}


def language_of(path):
    if path.name == "CMakeLists.txt":
        return CMAKE
    if path.suffix == "":
        with path.open("rb") as file:
            return SHELL if re.match(rb"#!.*\b(ba)?sh\b", file.readline()) else None
    return LANGUAGES.get(path.suffix)


def blank(match):
    """What it matches as spaces, in as many lines."""
    return re.sub(r"[^\n]", " ", match.group())


NO_CODE = re.compile(r'R"(?P<mark>[^(\s]*)\(.*?\)(?P=mark)"'  # a raw string
                     r'|"(?:\\.|[^"\\\n])*"'
                     r"|(?<![0-9a-fA-F])'(?:\\.|[^'\\\n])+'"  # no digit separator
                     r"|//[^\n]*|/\*.*?\*/|(?<=\n)[ ]*#(?:[^\n]*\\\n)*[^\n]*", re.DOTALL)
HOLDS_FUNCTIONS = re.compile(r"\b(namespace|class|struct|union|enum|extern)\b[^()=]*$")


def cpp_functions(text):
    """(name, first line, last line) of each function that is in no other one."""
    code = NO_CODE.sub(blank, text)
    name, first = "", 0
    depth_inside = 0  # open braces inside a function
    start = 0  # where the words before the next brace begin
    for match in re.finditer(r"[{};]", code):
        mark, end = match.group(), match.end()
        if depth_inside:
            depth_inside += {"{": 1, "}": -1, ";": 0}[mark]
            if depth_inside == 0 and name:
                yield name, first, code.count("\n", 0, end) + 1
        elif mark == "{":
            head = code[start:end - 1]
            words = " ".join(re.sub(r"(public|private|protected):", "", head).split())
            is_data = words.endswith(("=", ",")) or "concept " in words
            if is_data or ("(" in words and not HOLDS_FUNCTIONS.search(words)):
                depth_inside = 1
                name = "" if is_data else (words.split("(")[0].split() or [words])[-1]
                first = code.count("\n", 0, start + len(head) - len(head.lstrip())) + 1
        if not depth_inside:
            start = end


def python_functions(text):
    for node in ast.walk(ast.parse(text)):
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            has_text = ast.get_docstring(node) is not None  # docstrings are not counted as code
            text = node.body[0].end_lineno - node.body[0].lineno + 1 if has_text else 0
            yield node.name, node.lineno + text, node.end_lineno


def shell_functions(text):
    name = None
    for number, line in enumerate(text.splitlines(), 1):
        head = re.match(r"(?:function +)?([\w-]+)\(\) *[{(]", line)
        if head and not re.search(r"[})]\s*(#.*)?$", line):
            name, first = head.group(1), number
        elif name and line.startswith(("}", ")")):
            yield name, first, number
            name = None


def cmake_functions(text):
    for number, line in enumerate(text.splitlines(), 1):
        head = re.match(r"(?:function|macro)\((\w+)", line)
        if head:
            name, first = head.group(1), number
        elif re.match(r"end(function|macro)\(", line):
            yield name, first, number


FUNCTIONS = {CPP: cpp_functions, CMAKE: cmake_functions, SHELL: shell_functions,
             PYTHON: python_functions}


def findings_in(path, place, language):
    """Each place beyond a limit, and how many functions were looked at."""
    text = path.read_text(encoding="utf-8")
    lines = text.splitlines()
    functions = list(FUNCTIONS[language](text))
    findings = [f"{place}:{number}: {len(line)} columns"
                for number, line in enumerate(lines, 1) if len(line) > LINE_WIDTH]
    findings += [f"{place}:{first}: {name} has {last - first + 1} lines"
                 for name, first, last in functions if last - first + 1 > FUNCTION_LINES]
    if len(lines) > FILE_LINES:
        findings.append(f"{place}: {len(lines)} lines")
    return findings, len(functions), len(lines)


def sources(top):
    yield top / "CMakeLists.txt"
    for folder in FOLDERS:
        yield from sorted(path for path in (top / folder).rglob("*") if path.is_file())


def main(top):
    findings = []
    n_files, n_functions, n_program_lines = 0, 0, 0
    for path in sources(top):
        language = language_of(path)
        if not language:
            continue
        place = path.relative_to(top)
        new_findings, functions, lines = findings_in(path, place, language)
        findings += new_findings
        n_files += 1
        n_functions += functions
        if place.parts[0] in ("src", "include") and language == CPP:
            n_program_lines += lines
    if n_files < 300 or n_functions < 2000:
        findings.append(f"only {n_files} files and {n_functions} functions found: a wrong folder?")
    print(*findings, sep="\n")
    print(f"{n_files} files, {n_functions} functions, {n_program_lines} lines of src and include; "
          f"limits: {LINE_WIDTH} columns, {FUNCTION_LINES} lines a function, {FILE_LINES} a file")
    return 1 if findings else 0


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1])))
