"""What the network lab needs of the machine, and its forwarder."""
import hashlib
import os
import shutil
import subprocess
import sys


class Lacking(Exception):
    """Something that the lab needs is not there; says what and how to get it."""

    def __init__(self, what, remedy):
        super().__init__(f"needs {what}: {remedy}")


def check_machine():
    if sys.platform != "linux":
        raise Lacking("Linux", "it is made of network namespaces")
    if os.geteuid() != 0:
        raise Lacking("root", "run it by sudo, or in a container started with --privileged")
    packages = {"ip": "iproute2", "unshare": "util-linux", "nsenter": "util-linux"}
    for tool, package in packages.items():
        if not shutil.which(tool):
            raise Lacking(f"the command '{tool}'", f"install the package {package}")
    try:
        os.close(os.open("/dev/net/tun", os.O_RDWR))
    except OSError as error:
        raise Lacking(
            f"/dev/net/tun ({error.strerror})",
            "modprobe tun; mkdir -p /dev/net; mknod /dev/net/tun c 10 200; in a container: "
            "--device /dev/net/tun --cap-add NET_ADMIN --cap-add SYS_ADMIN") from None
    kinds = ["--mount", "--net", "--uts", "--ipc", "--pid", "--fork"]
    probe = subprocess.run(["unshare", *kinds, "true"], stderr=subprocess.PIPE, text=True)
    if probe.returncode != 0:
        raise Lacking(f"the right to make namespaces ({probe.stderr.strip()})",
                      "CAP_SYS_ADMIN, in a container --privileged")


def read_bytes(name):
    with open(name, "rb") as file:
        return file.read()


def find_forwarder(here):
    """Path of the forwarder: $NETLAB_FORWARDER, or one built from the sources into the cache."""
    given = os.environ.get("NETLAB_FORWARDER")
    if given:
        if not os.access(given, os.X_OK):
            raise Lacking(f"the forwarder NETLAB_FORWARDER={given}",
                          "build the target netlab_forwarder, or unset it")
        return given
    installed = os.path.join(here, "netlab_forwarder")
    if os.access(installed, os.X_OK):
        return installed
    sources = [os.path.join(here, name) for name in ("forwarder.cpp", "port.hpp", "tun.hpp", "wire.hpp")]
    digest = hashlib.sha256(b"".join(read_bytes(name) for name in sources)).hexdigest()[:16]
    base = os.environ.get("XDG_CACHE_HOME") or os.path.expanduser("~/.cache")
    cache = os.path.join(base, "barchan-netlab")
    path = os.path.join(cache, f"forwarder-{digest}")
    if not os.access(path, os.X_OK):
        os.makedirs(cache, exist_ok=True)
        compiler = os.environ.get("CXX") or shutil.which("c++") or shutil.which("g++")
        if not compiler:
            raise Lacking("a C++20 compiler",
                          "install the package g++, or set NETLAB_FORWARDER to a built forwarder")
        fresh = f"{path}.{os.getpid()}"
        built = subprocess.run([compiler, "-std=c++20", "-O2", "-pthread", "-o", fresh, sources[0]])
        if built.returncode != 0:
            raise Lacking("its forwarder", f"{compiler} does not compile {sources[0]}")
        os.rename(fresh, path)
    return path
