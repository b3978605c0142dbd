"""Builds the package `fisherhill`: CMake makes the compiled module (target fisherhill_python), setuptools the rest.

What has been compiled in a build folder is used again. The folder is the one in the environment variable
FISHERHILL_BUILD, else build/program where `./start` has made it, else build/pip. What is missing for that is said in one
line before anything is compiled.
"""

import importlib.util
import os
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

source = pathlib.Path(__file__).resolve().parent
# Debian's packages that a build from nothing needs, by a header that each of them has (`start` lists the program's).
headers = {
    "libeigen3-dev": "eigen3/Eigen/Core",
    "libsundials-dev": "cvode/cvode.h",
    "libtbb-dev": "tbb/tbb.h",
    "libtinyxml2-dev": "tinyxml2.h",
    "libfmt-dev": "fmt/format.h",
    "nlohmann-json3-dev": "nlohmann/json.hpp",
    "libtoml11-dev": "toml.hpp",
    "libcli11-dev": "CLI/CLI.hpp",
    "libssl-dev": "openssl/evp.h",
    "pybind11-dev": "pybind11/pybind11.h",
}


def found(file, pattern):
    match = re.search(pattern, (source / file).read_text(encoding="utf-8"), re.MULTILINE)
    if match is None:
        raise SystemExit(f"setup.py: {file} has no line that matches {pattern}")
    return match.group(1)


def require_packages():
    """What pip does not install without isolation: lacking `wheel` it would say that bdist_wheel is an invalid command."""
    missing = [name for name in ("wheel", "numpy") if importlib.util.find_spec(name) is None]
    if "wheel" in missing and importlib.util.find_spec("setuptools.command.bdist_wheel") is not None:
        missing.remove("wheel")  # setuptools 70.1 does without
    if missing:
        raise SystemExit(
            f"setup.py: the Python of {sys.base_prefix} has no package {' and no '.join(missing)}; make the environment with "
            "Debian's Python (/usr/bin/python3 -m venv --system-site-packages v; Debian's packages: README.md, Installing "
            f"it), or install there first: {sys.executable} -m pip install {' '.join(missing)}"
        )


def folder_of_build():
    given = os.environ.get("FISHERHILL_BUILD")
    folder = pathlib.Path(given) if given else source / "build/program"
    return folder if given or (folder / "CMakeCache.txt").exists() else source / "build/pip"


def lacking():
    """Debian's packages that are not there, of compiler, tools and headers."""
    prefixes = [pathlib.Path(one) for one in (*os.environ.get("CMAKE_PREFIX_PATH", "").split(os.pathsep), sys.prefix, "/usr/local", "/usr") if one]
    packages = []
    if not (os.environ.get("CXX") or shutil.which("c++") or shutil.which("g++")):
        packages.append("g++")
    packages += [package for package, tool in (("cmake", "cmake"), ("ninja-build", "ninja")) if shutil.which(tool) is None]
    packages += [package for package, header in headers.items() if not any((prefix / "include" / header).exists() for prefix in prefixes)]
    if not (pathlib.Path(sysconfig.get_path("include")) / "Python.h").exists():
        packages.append("python3-dev")
    return packages


def require_build_packages():
    """A folder that has been configured has found what it needs."""
    packages = [] if (folder_of_build() / "CMakeCache.txt").exists() else lacking()
    if packages:
        raise SystemExit(
            "setup.py: to compile the module, what these Debian packages hold is missing: "
            f"apt-get install --no-install-recommends {' '.join(packages)}"
        )


def build_folder():
    """The build folder, and the options to configure it with."""
    folder = folder_of_build()
    cache = folder / "CMakeCache.txt"
    configured = cache.read_text(encoding="utf-8") if cache.exists() else ""
    options = ["-DFISHERHILL_PYTHON=ON"]
    if not configured:
        # the module needs neither pictures nor MPI
        options += ["--preset", "program", "-DFISHERHILL_VIEW=OFF", "-DFISHERHILL_MPI=OFF"]
    python = re.search(r"^Python3_EXECUTABLE:\w+=(.*)$", configured, re.MULTILINE)
    was_removed = python is not None and not os.path.exists(python.group(1))
    if "FISHERHILL_PYTHON:BOOL=ON" not in configured or was_removed:
        options.append(f"-DPython3_EXECUTABLE={sys.executable}")
    return folder.resolve(), options


class CMakeBuild(build_ext):
    def build_extension(self, extension):
        folder, options = build_folder()
        subprocess.run(["cmake", "-S", source, "-B", folder, *options], check=True, cwd=source)
        subprocess.run(["cmake", "--build", folder, "--target", "fisherhill_python"], check=True)
        name = "_fisherhill" + sysconfig.get_config_var("EXT_SUFFIX")
        built = folder / "python/fisherhill" / name
        if not built.exists():
            raise SystemExit(
                f"setup.py: {folder} is configured for another Python, since it has not made {name}; "
                f"configure it with -DPython3_EXECUTABLE={sys.executable}, or set FISHERHILL_BUILD to another folder"
            )
        target = pathlib.Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copy2(built, target)


require_packages()
if not {"sdist", "egg_info"} & set(sys.argv):
    require_build_packages()
(source / "build").mkdir(exist_ok=True)
setup(
    version=found("CMakeLists.txt", r"^project\(FisherHill VERSION ([0-9.]+) "),
    description=found("CMakeLists.txt", r'^  DESCRIPTION "(.*)"\)$'),
    author=found("CITATION.cff", r'^  - name: "(.*)"$'),
    license=found("CITATION.cff", r"^license: (.*)$"),
    package_dir={"": "python/src"},
    packages=["fisherhill"],
    package_data={"fisherhill": ["*.pyi", "py.typed"]},
    ext_modules=[Extension("fisherhill._fisherhill", sources=[])],
    cmdclass={"build_ext": CMakeBuild},
    options={"egg_info": {"egg_base": "build"}},
)
