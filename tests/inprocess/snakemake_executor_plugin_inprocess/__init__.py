"""A Snakemake executor that runs the scripts of all jobs in Snakemake's own process, for tests.

Python starts and imports everything once per build, instead of once per job. With QUICK_FIGURES in the environment,
figures are drawn, but PDF files stay empty and PNG files are small, because fonts and pixels take most of the time.
"""

import importlib
import os
import runpy
import sys
from io import BytesIO
from pathlib import Path
from types import SimpleNamespace

from snakemake_interface_executor_plugins.executors.base import SubmittedJobInfo
from snakemake_interface_executor_plugins.executors.real import RealExecutor
from snakemake_interface_executor_plugins.settings import CommonSettings

common_settings = CommonSettings(
    non_local_exec=False,
    implies_no_shared_fs=False,
    job_deploy_sources=False,
    pass_envvar_declarations_to_cmd=False,
    auto_deploy_default_storage_provider=False,
)
GIVEN = ("input", "output", "params", "wildcards", "threads", "resources", "log")


def encode_quickly(figure):
    """Lay a figure out and encode it in few pixels, and as an empty PDF file."""
    style, picture = importlib.import_module("conveyor_pipeline.figures.style"), BytesIO()
    with style.applied():
        style.lay_out(figure)
        figure.savefig(picture, format="png", dpi=20)
    return {"pdf": b"", "png": picture.getvalue()}


class Executor(RealExecutor):
    def run_job(self, job):
        info = SubmittedJobInfo(job=job)
        self.report_job_submission(info)
        try:
            if job.rule.script:
                script = (Path(str(job.rule.basedir)) / job.rule.script).resolve()
                if str(script.parent) not in sys.path:
                    sys.path.insert(0, str(script.parent))
                benchmarks = [job.benchmark] if job.benchmark else []
                for file in (*job.output, *job.log, *benchmarks):
                    Path(file).parent.mkdir(parents=True, exist_ok=True)
                for file in benchmarks:
                    Path(file).write_text("s\tmax_rss\n0.0\t0.0\n")
                if job.rule.name == "plot" and "QUICK_FIGURES" in os.environ:
                    importlib.import_module("conveyor_pipeline.figures.style").encode = encode_quickly
                given = SimpleNamespace(
                    rule=job.rule.name, scriptdir=str(script.parent), **{name: getattr(job, name) for name in GIVEN}
                )
                runpy.run_path(str(script), {"snakemake": given}, "__main__")
        except BaseException:
            self.print_job_error(info)
            self.report_job_error(info)
            raise
        self.report_job_success(info)

    def handle_job_exception(self, job, exception):
        raise exception

    def get_exec_mode(self):
        raise NotImplementedError

    def cancel(self):
        pass

    def shutdown(self):
        pass

    def get_python_executable(self):
        raise NotImplementedError

    @property
    def cores(self):
        return self.workflow.resource_settings.cores
