"""Ends from outside: a closed terminal, and the lock that a killed Snakemake leaves."""

import signal

import snakemake.exceptions
from snakemake.exceptions import WorkflowError

LOCKED = """Another Snakemake makes the same files, or one was killed and has left its lock.
Wait for the other one; if there is none:
  snakemake --unlock
  snakemake --rerun-incomplete    (with the targets and options as before: what was half done is made again)"""


class LockError(WorkflowError):
    """What Snakemake raises where it finds a lock, in words that name what to do."""

    def __init__(self):
        super().__init__(LOCKED)


def name_commands_at_a_lock() -> None:
    """Let Snakemake's refusal to run beside a lock name the commands that help."""
    snakemake.exceptions.LockException = LockError


def end_with_the_terminal() -> None:
    """Let SIGHUP, as from a closed terminal, end Snakemake as SIGTERM does; what nohup has started goes on."""
    if signal.getsignal(signal.SIGHUP) is signal.SIG_DFL:
        signal.signal(signal.SIGHUP, lambda number, frame: signal.raise_signal(signal.SIGTERM))
