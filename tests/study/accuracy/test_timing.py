"""Runs that take turns while their processor times are measured."""

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

    monkeypatch.setattr(timing, "process_time", lambda: clock)
    monkeypatch.setattr(timing, "TURN", 0.25)
    runs = [lasting("fast", 0.125), lasting("slow", 0.5), lasting("slowest", 2.0)]
    found, times = timing.run_in_turns(runs, repeats=3, seconds=1.0)
    assert found == ["fast", "slow", "slowest"]
    fast = ["fast"] * 2
    assert made == [*fast, "slow", "slowest", *fast, "slow", *fast]
    assert times == [[0.125] * 6, [0.5] * 2, [2.0]]
