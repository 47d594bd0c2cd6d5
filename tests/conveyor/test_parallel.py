"""Ranges of points in threads: each point once, short ranges at the end, and no work after an error."""

import threading

import pytest
from hypothesis import given
from hypothesis import strategies as st

from conveyor.parallel import for_each_chunk, ranges_of

COUNTS = st.integers(0, 5000)
THREADS = st.integers(1, 8)
CHUNKS = st.integers(1, 600)


@given(count=COUNTS, threads=THREADS, chunk=CHUNKS)
def test_ranges_cover_all_points_once_and_get_shorter(count, threads, chunk):
    ranges = list(ranges_of(count, threads, chunk))
    assert [point for begin, end in ranges for point in range(begin, end)] == list(range(count))
    lengths = [end - begin for begin, end in ranges]
    assert all(0 < length <= chunk for length in lengths)
    assert lengths[:-1] == sorted(lengths[:-1], reverse=True)


def test_the_last_range_is_short_where_threads_would_wait():
    assert [end - begin for begin, end in ranges_of(10, 1, 4)] == [4, 4, 2]
    lengths = [end - begin for begin, end in ranges_of(10_000, 2, 1000)]
    assert lengths[:8] == [1000] * 7 + [750]
    assert lengths[-4:] == [32, 30, 30, 37]


@pytest.mark.parametrize("threads", [1, 2, 5])
def test_every_point_is_computed_once(threads):
    seen = []
    for_each_chunk(lambda begin, end: seen.extend(range(begin, end)), 1000, threads=threads, chunk=64)
    assert sorted(seen) == list(range(1000))


@pytest.mark.parametrize(("count", "threads"), [(1, 2), (5, 1)])
def test_a_single_range_needs_no_thread(count, threads):
    ran = []
    for_each_chunk(lambda *place: ran.append((*place, threading.get_ident())), count, threads=threads, chunk=8)
    assert ran == [(0, count, threading.get_ident())]


def test_threads_work_side_by_side():
    both = threading.Barrier(2, timeout=20.0)
    for_each_chunk(lambda begin, end: both.wait() and None, 2, threads=2, chunk=1)


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
