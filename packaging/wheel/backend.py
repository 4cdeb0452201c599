# SPDX-License-Identifier: BSD-3-Clause
"""Makes a wheel of the Python module by CMake: a build backend as PEP 517 wants it, with nothing but Python itself.

    pip wheel . --no-deps [--config-settings build-dir=build/dev]

A build folder that is configured already, for the same Python, is used as it is; else build/wheel is configured.
"""
import base64
import hashlib
import pathlib
import re
import shutil
import subprocess
import sys
import sysconfig
import zipfile

SOURCE = pathlib.Path(__file__).resolve().parents[2]
LICENSES = {"LICENSE": "LICENSE", "copyright": "packaging/copyright"}  # in dist-info; the second for what the module links


def version():
    text = (SOURCE / "CMakeLists.txt").read_text(encoding="utf-8")
    return re.search(r"project\(helixnav VERSION ([\d.]+)", text).group(1)


def tag():
    python = f"cp{sys.version_info.major}{sys.version_info.minor}"
    return f"{python}-{python}-{re.sub('[-.]', '_', sysconfig.get_platform())}"


def metadata():
    return (f"Metadata-Version: 2.1\nName: helixnav\nVersion: {version()}\n"
            "Summary: Landmark navigation with an exact compressed EKF and particle-filter relocalisation\n"
            "License: BSD-3-Clause\n" + "".join(f"License-File: {name}\n" for name in LICENSES) +
            "Requires-Python: >=3.9\nRequires-Dist: numpy\n"
            "Description-Content-Type: text/markdown\n\n" + (SOURCE / "docs/python.md").read_text(encoding="utf-8"))


def run(*words):
    print("+", *words, flush=True)
    subprocess.run([str(word) for word in words], check=True)


def configure(folder):
    options = ["-DCMAKE_BUILD_TYPE=Release", "-DHELIXNAV_WITH_PYTHON=ON", "-DHELIXNAV_WITH_MRPT=OFF",
               "-DHELIXNAV_BUILD_TESTS=OFF", "-DHELIXNAV_INSTALL=OFF", f"-DPython3_EXECUTABLE={sys.executable}"]
    if shutil.which("ccache"):
        options.append("-DCMAKE_CXX_COMPILER_LAUNCHER=ccache")
    if shutil.which("ninja"):
        options += ["-G", "Ninja"]
    run("cmake", "-S", SOURCE, "-B", folder, *options)


def built_package(folder):
    """The folder of the package as it is imported from the build tree, for this Python."""
    if not (folder / "CMakeCache.txt").exists():
        configure(folder)
    run("cmake", "--build", folder, "--parallel", "--target", "helixnav_python")
    package = folder / "python" / "helixnav"
    suffix = sysconfig.get_config_var("EXT_SUFFIX")
    if not (package / f"_helixnav{suffix}").exists():
        raise SystemExit(f"{folder}: configured for another Python than {sys.executable}, whose modules end in {suffix}")
    return package


def files_of(package):
    """(name in the wheel, bytes)."""
    suffix = sysconfig.get_config_var("EXT_SUFFIX")
    for name in ("__init__.py", "__init__.pyi", "py.typed", f"_helixnav{suffix}"):
        yield f"helixnav/{name}", (package / name).read_bytes()
    info = f"helixnav-{version()}.dist-info"
    yield f"{info}/METADATA", metadata().encode()
    yield f"{info}/WHEEL", f"Wheel-Version: 1.0\nGenerator: helixnav\nRoot-Is-Purelib: false\nTag: {tag()}\n".encode()
    for name, path in LICENSES.items():
        yield f"{info}/{name}", (SOURCE / path).read_bytes()


def build_wheel(wheel_directory, config_settings=None, metadata_directory=None):
    folder = SOURCE / (config_settings or {}).get("build-dir", "build/wheel")
    name = f"helixnav-{version()}-{tag()}.whl"
    record = []
    with zipfile.ZipFile(pathlib.Path(wheel_directory) / name, "w", zipfile.ZIP_DEFLATED) as wheel:

        def add(path, data):
            entry = zipfile.ZipInfo(path)  # always the same time: the same files make the same wheel
            entry.external_attr = (0o755 if path.endswith(".so") else 0o644) << 16
            entry.compress_type = zipfile.ZIP_DEFLATED
            wheel.writestr(entry, data)

        for path, data in files_of(built_package(folder)):
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            record.append(f"{path},sha256={digest},{len(data)}")
            add(path, data)
        own = f"helixnav-{version()}.dist-info/RECORD"
        add(own, "\n".join([*record, f"{own},,", ""]))
    return name


def build_sdist(sdist_directory, config_settings=None):
    """What git holds, and PKG-INFO."""
    base = f"helixnav-{version()}"
    path = pathlib.Path(sdist_directory) / f"{base}.tar.gz"
    info = SOURCE / "build" / "PKG-INFO"
    info.parent.mkdir(exist_ok=True)
    info.write_text(metadata(), encoding="utf-8")
    run("git", "-C", SOURCE, "archive", f"--prefix={base}/", f"--add-file={info}", "-o", path.resolve(), "HEAD")
    return path.name
