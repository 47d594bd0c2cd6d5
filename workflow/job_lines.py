"""What Snakemake says of jobs on a terminal: a line as each begins. Its log file keeps all, a dry run the reasons."""

import logging
import time

from snakemake_interface_logger_plugins.common import LogEvent

# What the line stands for as well, and has no event of its own.
BESIDE = "Select jobs to execute"


class JobLines(logging.Filter):
    """On a handler: it shows a line for each job in place of what Snakemake says of it as it begins and ends."""

    def __init__(self, handler: logging.Handler):
        super().__init__()
        self.handler, self.done, self.total = handler, 0, 0

    def filter(self, record: logging.LogRecord) -> bool:
        match getattr(record, "event", None):
            case LogEvent.RUN_INFO:
                self.total = record.stats["total"]
            case LogEvent.PROGRESS:
                self.done, self.total = record.done, record.total
                return self.done == self.total
            case LogEvent.JOB_STARTED | LogEvent.JOB_FINISHED:
                return False
            case LogEvent.JOB_INFO if record.rule_msg:
                line = f"{time.strftime('%H:%M:%S')}  {self.done} of {self.total} done  {record.rule_msg}"
                self.handler.handle(logging.LogRecord(record.name, record.levelno, "", 0, line, None, None))
                return False
            case None:
                return not str(record.msg).startswith(BESIDE)
        return True


def show_a_line_per_job() -> None:
    """Let Snakemake's output to the terminal have a line for each job."""
    for handler in logging.getLogger("snakemake.logging").handlers:
        dry = any(getattr(one, "dryrun", False) for one in handler.filters)
        if handler.name == "DefaultStreamHandler" and not dry:
            handler.addFilter(JobLines(handler))
