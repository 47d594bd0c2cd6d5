"""When Snakemake looks for jobs that can begin."""

from snakemake.scheduling.job_scheduler import JobScheduler

look_again = JobScheduler._schedule_reevalutation


def look_again_at_the_limit(scheduler: JobScheduler, delay: int) -> None:
    """Look for jobs again after a delay (s) if as many have begun as may at once; else there is nothing to wait for.

    Not for a workflow with inputs from a queue, which Snakemake looks at by the same way.
    """
    if not scheduler.job_rate_limiter.get_free_jobs():
        look_again(scheduler, delay)


def look_for_jobs_when_one_ends() -> None:
    """Let Snakemake look for jobs when one ends, not every second as well.

    Each end of a job would begin a chain of such looks that lasts while jobs wait, and each look solves an integer
    program: after some dozens of jobs they keep a tenth of a processor busy.
    """
    JobScheduler._schedule_reevalutation = look_again_at_the_limit
