#!/usr/bin/env python3
# SPDX-License-Identifier: BSD-3-Clause
"""docs/how-to/cluster.md lists what the build asks for, and every recipe follows that list.

The tables of that page are compared with the CMake files, with the packages that
job_scripts/setup.sh and the container install, and with the recipes for Spack, EasyBuild and
conda-forge. The project, the recipes, the package, CITATION.cff and CHANGELOG.md have one version,
and the last two have one date.

usage: requirements.py SOURCE_FOLDER
"""

import ast
import pathlib
import re
import sys

top = pathlib.Path(sys.argv[1])
install = top / "docs" / "install"
page = top / "docs/how-to/cluster.md"
recipes = {
    "Spack": install / "spack_repo/carrom/packages/carrom/package.py",
    "EasyBuild": next(install.glob("easybuild/*.eb")),
    "conda-forge": install / "conda/meta.yaml",
}
problems = []

# Keywords of find_path and similar commands of CMake, which end the list of names.
END_OF_NAMES = {"PATHS", "HINTS", "PATH_SUFFIXES", "DOC", "REQUIRED", "NO_DEFAULT_PATH"}
PKG_CONFIG_WORDS = {"REQUIRED", "QUIET", "IMPORTED_TARGET", "GLOBAL"}
# The compiler comes with the toolchain there; conda writes it as {{ compiler("cxx") }}.
FROM_THE_TOOLCHAIN = {"C and C++20 compiler", "OpenMP", "MPI"}


def numbers(version):
    return [int(part) for part in re.findall(r"\d+", version)]


# Packages that the build searches.


def cmake_files():
    for path in sorted(top.rglob("*")):
        is_cmake = path.name == "CMakeLists.txt" or ".cmake" in path.suffixes
        folders = path.relative_to(top).parts[:-1]
        if is_cmake and not any(name.startswith(("build", ".")) for name in folders):
            yield path


def asked_names(command, words):
    if command in ("find_package", "find_dependency"):
        return words[:1]
    if command in ("pkg_check_modules", "pkg_search_module"):
        modules = [word for word in words[1:] if word not in PKG_CONFIG_WORDS]
        return [re.split("[<>=]", module)[0] for module in modules]
    names = []
    for word in words[1:]:
        if word in END_OF_NAMES:
            break
        if word != "NAMES":
            names.append(word)
    return names


def asked_by_cmake():
    """{name: (file:line, version or None)} of every search in every CMake file."""
    commands = "find_package|find_dependency|find_path|find_library|find_file|find_program"
    pattern = re.compile(rf"\b({commands}|pkg_check_modules|pkg_search_module)\s*\(([^)]*)\)")
    asked = {}
    for path in cmake_files():
        text = re.sub(r"#[^\n]*", "", path.read_text())
        for match in pattern.finditer(text):
            words = [word.strip('"') for word in match.group(2).split()]
            if words[0].startswith("CARROM_LICENSE_"):
                continue  # optional
            line = text.count("\n", 0, match.start()) + 1
            version = words[1] if len(words) > 1 and words[1][0].isdigit() else None
            for name in asked_names(match.group(1), words):
                asked.setdefault(name, (f"{path.relative_to(top)}:{line}", version))
    asked.pop("Carrom", None)  # programs that use the library search Carrom itself
    return asked


# Packages that the page lists.


def tables():
    """Every table of the page as a list of rows; a row is {column: cell}."""
    result, header = [], None
    for line in page.read_text().splitlines():
        cells = [cell.strip() for cell in line.strip("|").split("|")]
        if not line.startswith("|"):
            header = None
        elif header is None:
            header = cells
            result.append([])
        elif not set(line) <= set("|- "):
            result[-1].append(dict(zip(header, cells)))
    return result


def rows_with(column):
    return [row for table in tables() for row in table if column in row]


def listed_names(row):
    return re.findall(r"`([^`]+)`", row["CMake asks for"])


def check_searches():
    asked = asked_by_cmake()
    listed = {name: row for row in rows_with("CMake asks for") for name in listed_names(row)}
    for name, (place, version) in asked.items():
        if name not in listed:
            problems.append(f"{place} asks for {name}, which {page.name} does not list")
        elif version and not listed[name]["at least"].startswith(version.split("...")[0]):
            least = listed[name]["at least"]
            problems.append(f"{place} asks for {name} {version}, {page.name} says {least}")
    for name in listed:
        if name not in asked and name not in ("cmake_minimum_required", "project"):
            problems.append(f"{page.name} lists {name}, which no CMake file asks for")
    least = re.search(r"cmake_minimum_required\(VERSION ([\d.]+)", cmake_text()).group(1)
    if listed["cmake_minimum_required"]["at least"] != least:
        problems.append(f"CMakeLists.txt needs CMake {least}, {page.name} says otherwise")


def cmake_text():
    """The main file first, because the minimum version stands there."""
    return "".join((top / name).read_text() for name in ("CMakeLists.txt", "src/gpu/cuda.cmake"))


def check_options():
    """Options that pages and recipes give to CMake exist."""
    pages = [page, top / "docs/start/install.md", top / "README.md"]
    for path in [*sorted(install.rglob("*")), *pages]:
        if not path.is_file():
            continue
        for option in set(re.findall(r"(?:CARROM|RANDOM123)_[A-Z_]+", path.read_text())):
            if not re.search(rf"\b{option}\b", cmake_text()):
                problems.append(f"{path.relative_to(top)}: CMakeLists.txt has no {option}")


# Packages that the scripts install, and dependencies of the recipes.


def program_rows():
    return rows_with("EasyBuild")


def check_debian():
    setup = (top / "job_scripts/setup.sh").read_text()
    container = (install / "container.sh").read_text()
    for row in rows_with("Debian"):
        if row["Debian"] == "none":  # of PyPI, for options that are off
            continue
        name = re.compile(rf"(?<![\w-]){re.escape(row['Debian'])}(?![\w-])")
        # The tests' packages need Python for a virtual environment, which brings python3.
        if not name.search(setup) and row["package"] != "Python":
            problems.append(f"job_scripts/setup.sh does not install {row['Debian']}")
        if "EasyBuild" in row and not name.search(container):
            problems.append(f"container.sh does not install {row['Debian']}")


def spack_dependencies():
    """{name: version or None} of every depends_on("name@version: ...")."""
    result = {}
    for node in ast.walk(ast.parse(recipes["Spack"].read_text())):
        if isinstance(node, ast.Call) and getattr(node.func, "id", "") == "depends_on":
            spec = re.match(r"([\w-]+)(?:@([\d.]+):)?", node.args[0].value)
            result[spec.group(1)] = spec.group(2)
    return result


def conda_dependencies():
    text = recipes["conda-forge"].read_text()
    entries = re.findall(r"^    - ([\w.-]+)(?: >=([\d.]+))?", text, re.M)
    result = {}
    for name, version in entries:
        result[name] = version or result.get(name)
    return result


def easybuild_recipe():
    words = {"SYSTEM": "system", "SOURCELOWER_TAR_GZ": "archive"}
    exec(recipes["EasyBuild"].read_text(), words)  # EasyBuild reads its recipes like this, too
    return words


def easybuild_dependencies():
    words = easybuild_recipe()
    return {entry[0]: entry[1] for entry in words["builddependencies"] + words["dependencies"]}


def check_recipes():
    least = {row["package"]: row["at least"] for row in rows_with("at least")}
    dependencies = {
        "Spack": spack_dependencies(),
        "EasyBuild": easybuild_dependencies(),
        "conda-forge": conda_dependencies(),
    }
    for row in program_rows():
        if row["package"] not in least:
            problems.append(f"{page.name} has no version of {row['package']}")
        elif row["package"] not in FROM_THE_TOOLCHAIN:
            check_dependencies(row, least[row["package"]], dependencies)


def check_dependencies(row, least, dependencies):
    """The recipe of each package system has the row's package, in a version that will do."""
    for system, has in dependencies.items():
        name = row[system].split()[0]
        if name == "none":
            continue
        if name not in has:
            problems.append(f"{recipes[system].name} does not depend on {name}")
        elif numbers(least):
            check_version(system, name, has[name], least)


def check_version(system, name, version, least):
    where = f"{recipes[system].name}: {name} {version}"
    if system == "EasyBuild":  # names one version; a date is no version
        if len(numbers(version)) > 1 and numbers(version) < numbers(least):
            problems.append(f"{where} is older than {least} of {page.name}")
    elif version != least:
        problems.append(f"{where} is not the {least} of {page.name}")


# One version everywhere.


def check_project_version():
    version = re.search(r"project\(carrom VERSION ([\d.]+)", cmake_text()).group(1)
    places = {
        "CITATION.cff": r"^version: (\S+)",
        "CHANGELOG.md": r"^## ([\d.]+)",
        "docs/carrom.1": r'"Carrom (\S+)"',
        "src/python/pyproject.toml": r'^version = "(\S+)"',
        "src/python/carrom/__init__.py": r'^__version__ = "(\S+)"',
        "docs/install/conda/meta.yaml": r'set version = "(\S+)"',
        str(recipes["Spack"].relative_to(top)): r'version\("(\S+)"',
        "docs/how-to/cluster.md": r"carrom@(\S+)",
    }
    for place, pattern in places.items():
        found = re.search(pattern, (top / place).read_text(), re.M)
        if not found or found.group(1) != version:
            problems.append(f"{place} does not have version {version} of CMakeLists.txt")
    dates = [re.search(pattern, (top / place).read_text(), re.M) for place, pattern in (
        ("CITATION.cff", r"^date-released: (\S+)"),
        ("CHANGELOG.md", rf"^## {re.escape(version)}, (\S+)"))]
    if None in dates or dates[0].group(1) != dates[1].group(1):
        problems.append(f"CITATION.cff and CHANGELOG.md do not have one date for {version}")
    easybuild = easybuild_recipe()
    toolchain = "{name}-{version}".format(**easybuild["toolchain"])
    name = f"{easybuild['name']}-{version}-{toolchain}.eb"
    if easybuild["version"] != version or recipes["EasyBuild"].name != name:
        problems.append(f"the EasyBuild recipe is not {name} with version {version}")


check_searches()
check_options()
check_debian()
check_recipes()
check_project_version()
for problem in problems:
    print(f"FAILED: {problem}")
print(f"{len(asked_by_cmake())} searches of CMake and {len(program_rows())} packages compared")
sys.exit(1 if problems else 0)
