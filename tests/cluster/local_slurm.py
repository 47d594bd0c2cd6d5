"""Start and stop a Slurm of one node on this machine that listens on the loopback interface only."""

import os
import shutil
import signal
import socket
import subprocess
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from pathlib import Path

PACKAGES = "slurmctld slurmd slurm-client munge"
PROGRAMS = ("slurmctld", "slurmd", "sbatch", "munged")
# Snakemake's plugin removes SLURM_CONF from the environment of its jobs, so the file must be where Slurm expects it.
CONFIGURATION = Path("/etc/slurm/slurm.conf")
MUNGE_SOCKET_FOLDER = Path("/run/munge")
PATIENCE = 30.0  # s, until a daemon answers

SLURM = """\
ClusterName=test
SlurmctldHost={host}(127.0.0.1)
CommunicationParameters=NoInAddrAny,NoCtldInAddrAny
AuthType=auth/munge
SlurmUser=root
StateSaveLocation={folder}/slurmctld
SlurmdSpoolDir={folder}/slurmd
SlurmctldPidFile={folder}/slurmctld.pid
SlurmdPidFile={folder}/slurmd.pid
SlurmctldLogFile={folder}/slurmctld.log
SlurmdLogFile={folder}/slurmd.log
ProctrackType=proctrack/linuxproc
TaskPlugin=task/none
JobAcctGatherType=jobacct_gather/none
SelectType=select/cons_tres
SelectTypeParameters=CR_Core_Memory
SchedulerParameters=batch_sched_delay=0,sched_interval=2
SlurmdParameters=config_overrides
MpiDefault=none
ReturnToService=2
AccountingStorageType=accounting_storage/none
NodeName={host} NodeAddr=127.0.0.1 CPUs=2 RealMemory=16000 State=UNKNOWN
PartitionName=main Nodes={host} Default=YES MaxTime=INFINITE State=UP
"""


def obstacle() -> str | None:
    """The reason why Slurm cannot be started here, with the remedy; None if it can."""
    if missing := [program for program in PROGRAMS if not shutil.which(program)]:
        return f"{', '.join(missing)} not found: apt-get install --no-install-recommends {PACKAGES}"
    if os.getuid() != 0:
        return "the daemons of Slurm are started by root: run these tests as root"
    if CONFIGURATION.exists():
        return f"{CONFIGURATION} is there already: these tests would replace the Slurm of this machine"
    return None


def answers(*command: str, text: str = "") -> bool:
    """Whether a command succeeds and prints this text."""
    found = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, check=False)
    return found.returncode == 0 and text in found.stdout


def until(condition: Callable[[], bool], what: str, patience: float = PATIENCE) -> None:
    """Wait until a condition holds; TimeoutError if it does not in `patience` (s)."""
    end = time.monotonic() + patience
    while not condition():
        if time.monotonic() > end:
            raise TimeoutError(f"{what}: not in {patience:g} s")
        time.sleep(0.1)


@contextmanager
def daemon(log: Path, *command: str, **options) -> Iterator[None]:
    """Run a program in the foreground of a new session, and end it by its process id."""
    with (
        log.open("w") as said,
        subprocess.Popen(
            command, stdin=subprocess.DEVNULL, stdout=said, stderr=said, start_new_session=True, **options
        ) as process,
    ):
        try:
            yield
        finally:
            process.send_signal(signal.SIGTERM)
            try:
                process.wait(PATIENCE)
            except subprocess.TimeoutExpired:
                process.kill()


def munge_works() -> bool:
    return answers("bash", "-c", "munge -n | unmunge")


@contextmanager
def munge(folder: Path) -> Iterator[None]:
    """Munge, which signs the messages of Slurm; a running Munge is used and kept."""
    if munge_works():
        yield
        return
    MUNGE_SOCKET_FOLDER.mkdir(mode=0o755, exist_ok=True)
    shutil.chown(MUNGE_SOCKET_FOLDER, "munge", "munge")
    with daemon(folder / "munged.log", "munged", "--foreground", user="munge", group="munge", extra_groups=[]):
        until(munge_works, "munge signs nothing")
        yield


@contextmanager
def configuration(folder: Path) -> Iterator[None]:
    CONFIGURATION.write_text(SLURM.format(host=socket.gethostname().partition(".")[0], folder=folder))
    try:
        yield
    finally:
        CONFIGURATION.unlink()


@contextmanager
def no_jobs_left() -> Iterator[None]:
    try:
        yield
    finally:
        cancel("--user=root")
        until(lambda: not jobs(), "jobs end")


@contextmanager
def slurm(folder: Path) -> Iterator[None]:
    """A Slurm whose state and logs are in `folder`."""
    for name in ("slurmctld", "slurmd"):
        (folder / name).mkdir()
    with ExitStack() as stack:
        stack.enter_context(configuration(folder))
        stack.enter_context(munge(folder))
        for name in ("slurmctld", "slurmd"):
            stack.enter_context(daemon(folder / f"{name}.out", name, "-D"))
        until(lambda: answers("sinfo", "--noheader", "--format=%T", text="idle"), f"no idle node, see {folder}")
        stack.enter_context(no_jobs_left())
        yield


def jobs(state: str = "PENDING,RUNNING,COMPLETING") -> dict[str, str]:
    """The jobs in these states: rule and wildcards, as Snakemake names them, by id."""
    found = subprocess.run(
        ["squeue", "--noheader", f"--states={state}", "--format=%i|%k"], capture_output=True, text=True, check=True
    )
    return dict(line.split("|", 1) for line in found.stdout.splitlines())


def cancel(*which: str) -> None:
    """Cancel jobs: their ids, or options of scancel."""
    subprocess.run(["scancel", *which], check=True)
