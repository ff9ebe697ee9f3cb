"""The hosts of the network lab: namespaces that live exactly as long as the processes in them.

    netlab (front)               outside; passes signals on, returns the exit status
      supervisor                 PID 1 of the lab's own PID namespace; own mounts and network
        forwarder                made the TUN devices here; each was then moved to its host
        holder lab1, lab2, ...   keeps one host: network, host name, IPC, /dev/shm, /sys
        program                  entered lab1 by the agent; mpirun enters the other hosts by it

Nothing has a name outside. When the front dies, however it dies, the kernel kills the supervisor
(PR_SET_PDEATHSIG) and with PID 1 of a namespace all that is in it, daemons too; namespaces and
devices go with their last process.
"""
import ctypes
import os
import signal
import socket
import subprocess
import sys
import tempfile
import time
import uuid

CLONE_NEWNS, CLONE_NEWUTS, CLONE_NEWIPC = 0x00020000, 0x04000000, 0x08000000
CLONE_NEWPID, CLONE_NEWNET = 0x20000000, 0x40000000
MS_BIND, MS_REC, MS_SLAVE = 1 << 12, 1 << 14, 1 << 19
PR_SET_PDEATHSIG = 1
GRACE = 5.0  # seconds between asking the program to end and killing it
AGENT = os.path.join(os.path.dirname(os.path.realpath(__file__)), "agent")
LIBC = ctypes.CDLL(None, use_errno=True)


def call(name, *arguments):
    if getattr(LIBC, name)(*arguments) != 0:
        code = ctypes.get_errno()
        raise OSError(code, f"{name}{arguments}: {os.strerror(code)}")


def mount(source, target, kind, flags=0):
    call("mount", source.encode(), target.encode(), kind.encode() if kind else None, flags, None)


def run(options, forwarder, command):
    """Builds the lab, runs the command on lab1, takes all down. Returns the exit status."""
    read_go, write_go = os.pipe()
    call("unshare", CLONE_NEWPID)  # for the child only
    child = os.fork()
    if child == 0:
        os.close(write_go)
        call("prctl", PR_SET_PDEATHSIG, signal.SIGKILL, 0, 0, 0)
        if os.read(read_go, 1) != b"g":  # the front died before the line above
            os._exit(3)
        os._exit(supervise(options, forwarder, command))
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGHUP):
        signal.signal(number, lambda *_: os.kill(child, signal.SIGTERM))
    os.write(write_go, b"g")
    _, status = os.waitpid(child, 0)
    return os.waitstatus_to_exitcode(status) if os.WIFEXITED(status) else 3


def supervise(options, forwarder, command):
    try:
        return Supervisor(options).run(forwarder, command)
    except (OSError, RuntimeError, subprocess.SubprocessError) as error:
        print(f"netlab: the lab could not be built: {error}", file=sys.stderr)
        return 3


def own_file(text, target):
    """Shows a file with this text at a path, in this mount namespace only."""
    with tempfile.NamedTemporaryFile("w", prefix="netlab-") as file:
        file.write(text)
        file.flush()
        os.chmod(file.name, 0o644)
        mount(file.name, target, None, MS_BIND)


def set_sysctl(name, value):
    with open("/proc/sys/" + name, "w") as file:
        file.write(value)


class Supervisor:
    def __init__(self, options):
        self.options = options
        self.names = [f"lab{i + 1}" for i in range(options.hosts)]
        self.asked_to_end = False

    def run(self, forwarder, command):
        signal.signal(signal.SIGTERM, self.end)
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # of a terminal: the program's business
        call("unshare", CLONE_NEWNS | CLONE_NEWNET)
        mount("none", "/", None, MS_REC | MS_SLAVE)
        mount("proc", "/proc", "proc")
        table = [f"10.77.0.{i + 1} {name}\n" for i, name in enumerate(self.names)]
        own_file("127.0.0.1 localhost\n" + "".join(table), "/etc/hosts")
        self.holders = [self.hold(name) for name in self.names]
        self.start_forwarder(forwarder)
        for index, pid in enumerate(self.holders):
            self.connect(index, pid)
        # Kept: a Popen that is collected as garbage reaps its process, and watch() would wait for ever.
        self.program = subprocess.Popen([AGENT, "--in", os.getcwd(), "lab1"] + command,
                                        env=self.environment())
        return self.watch(self.program.pid)

    def hold(self, name):
        """Forks the process that keeps a host. Returns its PID once the host is there."""
        read_end, write_end = os.pipe()
        pid = os.fork()
        if pid == 0:
            try:
                signal.signal(signal.SIGTERM, signal.SIG_DFL)
                call("unshare", CLONE_NEWNET | CLONE_NEWUTS | CLONE_NEWIPC | CLONE_NEWNS)
                socket.sethostname(name)
                mount("netlab", "/sys", "sysfs")  # shows the devices of this host
                mount("netlab", "/dev/shm", "tmpfs")
                # Some libraries tell hosts apart by it.
                own_file(f"{uuid.uuid4()}\n", "/proc/sys/kernel/random/boot_id")
                os.write(write_end, b"ok")
                while True:
                    signal.pause()
            except OSError as error:
                os.write(write_end, str(error).encode())
            os._exit(1)
        os.close(write_end)
        answer = os.read(read_end, 1000).decode()
        os.close(read_end)
        if answer != "ok":
            raise RuntimeError(f"host {name}: {answer}")
        return pid

    def start_forwarder(self, forwarder):
        o = self.options
        values = {"hosts": o.hosts, "delay-ns": round(o.delay), "jitter-ns": round(o.jitter),
                  "spike-share": o.spike[0], "spike-factor": o.spike[1], "rate-bps": o.rate,
                  "queue-bytes": o.queue, "keep-order": int(not o.reorder), "seed": o.seed,
                  "offload": int(not o.no_offload), "even-price": int(o.even_price)}
        if self.cpu_lists():
            values["cpus"] = ":".join(self.cpu_lists())
        if o.stats:
            values["stats"] = os.path.abspath(o.stats)
        words = [word for key, value in values.items() for word in (f"--{key}", str(value))]
        self.forwarder = subprocess.Popen([forwarder] + words, stdin=subprocess.DEVNULL,
                                          stdout=subprocess.PIPE)
        if self.forwarder.stdout.readline() != b"ready\n":
            raise RuntimeError("the forwarder does not start")

    def connect(self, index, pid):
        """Moves a host's device into it and sets its network up."""
        move = f"link set netlab{index + 1} netns {pid} name lab0"
        subprocess.run(["ip"] + move.split(), check=True)
        batch = (f"link set lo up\nlink set lab0 mtu {self.options.mtu} txqueuelen 10000\n"
                 f"addr add 10.77.0.{index + 1}/24 dev lab0\nlink set lab0 up\n")
        enter = ["nsenter", "--net", "--target", str(pid)]
        # Pacing (BBR) and neighbour discovery (IPv6) would add delays that are not the network's.
        # Kernels may allow a namespace only some ways of congestion control, Reno always.
        tuning = ("echo 1 > /proc/sys/net/ipv6/conf/lab0/disable_ipv6; for way in cubic reno; do "
                  "echo $way > /proc/sys/net/ipv4/tcp_congestion_control && break; done")
        subprocess.run(enter + ["sh", "-c", f"({tuning}) 2>/dev/null; exec ip -batch -"],
                       input=batch, text=True, check=True)

    def environment(self):
        env = dict(os.environ)
        env["NETLAB_HOSTS"] = " ".join(f"{n}={p}" for n, p in zip(self.names, self.holders))
        env["NETLAB_ON"] = AGENT
        env["NETLAB_CPUS"] = " ".join(f"{n}={c}" for n, c in zip(self.names, self.cpu_lists()))
        env["NETLAB_REALTIME"] = "yes" if self.options.realtime else ""
        agent = {"OMPI_MCA_plm_rsh_agent": AGENT, "PRTE_MCA_plm_ssh_agent": AGENT}
        usual = {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                 "PRTE_ALLOW_RUN_AS_ROOT": "1", "PRTE_ALLOW_RUN_AS_ROOT_CONFIRM": "1",
                 "OMPI_MCA_btl_tcp_if_include": "lab0", "OMPI_MCA_oob_tcp_if_include": "lab0",
                 "PRTE_MCA_prte_if_include": "lab0",
                 "OMPI_MCA_orte_tmpdir_base": "/dev/shm", "PRTE_MCA_prte_tmpdir_base": "/dev/shm",
                 "UCX_NET_DEVICES": "lab0", "UCX_TLS": "tcp,self,sm",
                 "FI_TCP_IFACE": "lab0", "FI_SOCKETS_IFACE": "lab0"}
        ranks = len(self.names) * self.options.ranks_per_host
        if ranks > len(os.sched_getaffinity(0)):  # who spins would starve whom he waits for
            usual["OMPI_MCA_mpi_yield_when_idle"] = "1"
        given = dict(pair.split("=", 1) for pair in self.options.env)
        return {**usual, **env, **agent, **given}

    def cpu_lists(self):
        """For each host its cores; nothing when there are not enough."""
        cpus = sorted(os.sched_getaffinity(0))
        hosts = len(self.names)
        if self.options.no_pin or len(cpus) < hosts:
            return []
        cuts = [i * len(cpus) // hosts for i in range(hosts + 1)]
        return [",".join(map(str, cpus[begin:end])) for begin, end in zip(cuts, cuts[1:])]

    def end(self, *_):
        self.asked_to_end = True

    def watch(self, program):
        """Reaps as PID 1 must, until the program ends. Returns its exit status."""
        signals = {signal.SIGCHLD, signal.SIGTERM}
        signal.pthread_sigmask(signal.SIG_BLOCK, signals)  # from here on sigtimedwait takes them
        deadline = None
        while True:
            pid, status = os.waitpid(-1, os.WNOHANG)
            if pid == self.forwarder.pid:
                print("netlab: the forwarder ended, there is no network any more", file=sys.stderr)
                return 3
            if pid == program:
                self.stop_forwarder()
                code = os.waitstatus_to_exitcode(status)
                return code if code >= 0 else 128 - code
            if pid != 0:
                continue
            signalled = signal.sigtimedwait(signals, 1.0)
            self.asked_to_end |= signalled is not None and signalled.si_signo == signal.SIGTERM
            if self.asked_to_end and deadline is None:
                deadline = time.monotonic() + GRACE
                os.kill(program, signal.SIGTERM)
            if deadline and time.monotonic() > deadline:
                return 128 + signal.SIGTERM

    def stop_forwarder(self):
        """Lets it write its figures; what does not end now ends with the lab."""
        self.forwarder.terminate()
        try:
            self.forwarder.wait(2.0)
        except subprocess.TimeoutExpired:
            pass
