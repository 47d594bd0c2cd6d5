"""Ranges of points in threads: each point once, short ranges at the end, and no work after an error."""

import threading

import pytest
from hypothesis import given
from hypothesis import strategies as st

from conveyor.parallel import call_interruptibly, for_each_chunk, next_length


@given(count=st.integers(1, 5000), threads=st.integers(1, 8), chunk=st.integers(1, 600), seconds=st.floats(0.0, 10.0))
def test_ranges_cover_all_points_and_are_no_longer_than_a_chunk(count, threads, chunk, seconds):
    left, length = count, 0
    while left:
        length = next_length(left, threads, chunk, length, seconds)
        assert 0 < length <= min(left, chunk)
        left -= length


def test_ranges_take_a_second():
    length, lengths = 0, []
    for _ in range(8):
        length = next_length(10**6, 1, 4096, length, 1e-3 * length)  # a point takes a millisecond
        lengths.append(length)
    assert lengths == [8, 32, 128, 512, 1000, 1000, 1000, 1000]
    assert next_length(10**6, 1, 4096, 500, 50.0) == 10  # points that take longer follow


def test_the_last_range_is_short_where_threads_would_wait():
    assert next_length(1000, 2, 1000, 1000, 0.01) == 250
    assert next_length(40, 2, 1000, 1000, 0.01) == 40


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_every_point_is_computed_once(threads):
    seen = []
    for_each_chunk(lambda begin, end: seen.extend(range(begin, end)), 1000, threads=threads, chunk=64)
    assert sorted(seen) == list(range(1000))


@pytest.mark.parametrize(("count", "threads"), [(1, 2), (1, 1)])
def test_a_single_range_needs_no_thread(count, threads):
    ran = []
    for_each_chunk(lambda *place: ran.append((*place, threading.get_ident())), count, threads=threads, chunk=8)
    assert ran == [(0, count, threading.get_ident())]


@pytest.mark.parametrize("chunk", [1, 64])
def test_threads_work_side_by_side(chunk):
    """Also on fewer points than a chunk."""
    both = threading.Barrier(2, timeout=20.0)
    for_each_chunk(lambda begin, end: both.wait() and None, 2, threads=2, chunk=chunk)


def test_work_within_work_does_not_wait_for_busy_threads():
    seen = []

    def work(begin, end):
        for_each_chunk(lambda *inner: seen.append((begin, *inner)), 3, threads=2, chunk=1)

    for_each_chunk(work, 20, threads=2, chunk=1)
    assert sorted(seen) == [(k, j, j + 1) for k in range(20) for j in range(3)]


@pytest.mark.parametrize("wrong", [0, 1])
def test_an_error_in_either_thread_is_raised_and_ends_the_work_of_both(wrong):
    both, seen = threading.Barrier(2, timeout=20.0), []

    def work(begin, end):
        seen.append(begin)
        if begin < 2:
            both.wait()
        if begin == wrong:
            raise ValueError(f"no number {wrong}")

    with pytest.raises(ValueError, match=f"no number {wrong}"):
        for_each_chunk(work, 1_000_000, threads=2, chunk=1)
    assert len(seen) < 1_000_000


def test_an_error_stops_the_long_work_of_the_other_thread():
    both, stopped = threading.Barrier(2, timeout=20.0), threading.Event()

    def work(begin, end):
        def follow():
            both.wait()
            assert stopped.wait(20.0)

        if threading.current_thread() is threading.main_thread():
            both.wait()
            raise KeyboardInterrupt
        call_interruptibly(follow, stopped.set, is_long=True)

    with pytest.raises(KeyboardInterrupt):
        for_each_chunk(work, 2, threads=2, chunk=1)
    assert stopped.is_set()


def test_an_error_of_long_work_is_raised():
    with pytest.raises(ZeroDivisionError):
        call_interruptibly(lambda: 1 / 0, lambda: None, is_long=True)
