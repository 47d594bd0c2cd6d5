"""Runs that take turns while their processor times are measured."""

import threading
import time
from functools import partial

import pytest

from conveyor import Conveyor, simulate
from conveyor_pipeline.study.accuracy import timing


def test_runs_take_turns_until_each_has_run_long_enough(monkeypatch):
    clock, made = 0.0, []

    def lasting(name, seconds):
        def run():
            nonlocal clock
            clock += seconds
            made.append(name)
            return name

        return run

    monkeypatch.setattr(timing, "thread_time", lambda: clock)
    monkeypatch.setattr(timing, "TURN", 0.25)
    runs = [lasting("fast", 0.125), lasting("slow", 0.5), lasting("slowest", 2.0)]
    found, times = timing.run_in_turns(runs, repeats=3, seconds=1.0)
    assert found == ["fast", "slow", "slowest"]
    fast = ["fast"] * 2
    assert made == [*fast, "slow", "slowest", *fast, "slow", *fast]
    assert times == [[0.125] * 6, [0.5] * 2, [2.0]]


def test_work_of_other_threads_does_not_count():
    stop = threading.Event()

    def spin():
        while not stop.is_set():
            pass

    other = threading.Thread(target=spin)
    other.start()
    try:
        _, ((lasted,),) = timing.run_in_turns([lambda: time.sleep(0.3)], repeats=1, seconds=1e-9)
    finally:
        stop.set()
        other.join()
    assert lasted < 0.1
    # A long run of fixed steps is counted, although the main thread would give it to another one.
    conveyor = Conveyor(acceleration=32.0)
    run = partial(simulate, conveyor, duration=2.0, method="euler", step=5e-7)
    run()
    begin = time.process_time()
    _, ((lasted,),) = timing.run_in_turns([run], repeats=1, seconds=1e-9)
    assert lasted == pytest.approx(time.process_time() - begin, rel=0.5, abs=0.05)
