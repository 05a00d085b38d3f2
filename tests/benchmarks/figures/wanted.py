"""The figures that the finished system must show. Where two speak of one thing, the stricter one stands here.

number: that of the list of wanted figures, which the benchmarks' first lines name as well.
"""

from __future__ import annotations

from dataclasses import dataclass

from tests.benchmarks.figures.record import Bound


@dataclass(frozen=True, slots=True)
class Wanted:
    """key: for programs. what: for people; the unit is that of every figure measured for it.

    test: where nothing is measured because a test of every run asserts it, "file::name".
    """

    number: int
    key: str
    what: str
    unit: str
    at_least: float | None = None
    at_most: float | None = None
    test: str = ""

    def bound(self) -> Bound:
        return Bound(key=self.key, at_least=self.at_least, at_most=self.at_most)


WANTED = (
    # The planner
    Wanted(23, "rollout", "a rollout, one thread", "us", at_most=3.0),
    Wanted(1, "rollout_ratio", "numpy reference over compiled kernel, same run", "times", at_least=40.0),
    Wanted(23, "rollout_two_threads", "a rollout on one thread over one on two", "times", at_least=1.7),
    Wanted(2, "plan_1000", "a plan, N = 1000, two threads", "ms", at_most=20.0),
    Wanted(23, "plan_3600", "a plan, N = 3600, two threads", "ms", at_most=15.0),
    Wanted(23, "joint_plan_3600", "a plan on the joint belief over one on the plain belief", "times", at_most=2.0),
    Wanted(2, "first_plan", "fresh process, warm cache: imports and the first plan", "s", at_most=0.5),
    Wanted(4, "table_4_2", "cells of Table 4.2 that differ from the thesis without an interpretation", "", at_most=0),
    Wanted(5, "study", "20,000 missions of Scenario 2, sequential halving N = 3600, 2 cores", "min", at_most=30.0),
    Wanted(5, "study_on_dask", "a study on k Dask workers: speed over k times that on one", "", at_least=0.9),
    Wanted(24, "s2_fast", "Scenario 2 fast, mean time to localization", "s", at_most=34.5),
    Wanted(24, "s2_medium", "Scenario 2 medium, mean time to localization", "s", at_most=54.5),
    Wanted(24, "s2_slow", "Scenario 2 slow, mean time to localization", "s", at_most=118.0),
    Wanted(24, "s3_medium", "Scenario 3 medium, mean time to localization", "s", at_most=81.0),
    Wanted(24, "field_medium", "field scenario, mean time to localization", "s", at_most=128.0),
    Wanted(24, "adaptive_turns", "field world: adaptive turns ahead of a wedge as wide as true", "s", at_least=15),
    Wanted(24, "listening", "field world: listening on the way ahead of a wedge as wide as true", "s", at_least=25),
    Wanted(24, "field_claims", "field world, new missions: localized in 400 s", "%", at_least=99.0),
    Wanted(24, "field_truth", "field world, new missions: truth in C95 at the claim", "%", at_least=93.0, at_most=97.0),
    Wanted(24, "field_beyond", "field world, new missions: error beyond 3 x stated", "%", at_most=0.5),
    Wanted(25, "eight_tags", "8 tags, mean time until all are localized", "s", at_most=400.0),
    Wanted(25, "four_tags", "4 tags, mean time until all are localized", "s", at_most=330.0),
    Wanted(25, "moving", "emitter moving at up to 0.4 m/s: truth in C95", "%", at_least=93.0, at_most=97.0),
    Wanted(26, "terrain", "1000 missions in real relief: clearance or ceiling violated", "", at_most=0),
    # Bearings and what is claimed from them
    Wanted(3, "sparse", "sparse reconstruction of 180 bins on 720 columns", "ms", at_most=5.0),
    Wanted(3, "sparse_optimum", "its objective against a convex solver's, relative", "", at_most=1e-6),
    Wanted(3, "bearing_rms", "bearing RMS over the Cramer-Rao bound, reference condition", "times", at_most=1.25),
    Wanted(3, "least_squares", "bearing RMS minus least squares' on the same sweeps, at worst", "deg", at_most=0.0),
    Wanted(17, "mismatch_sigma", "wrong pattern, each row: errors inside two sigma", "%", at_least=90.0),
    Wanted(17, "mismatch_axis", "wrong pattern, bearing RMS minus the principal axis', at worst", "deg", at_most=0.0),
    Wanted(14, "fault_crashes", "missions with a sensor fault that crashed", "", at_most=0),
    Wanted(14, "fault_truth", "truth in C95 of the claims with a sensor fault", "%", at_least=95.0),
    Wanted(17, "truth", "`crossfix study truth`, each row: truth in C95", "%", at_least=93.0, at_most=97.0),
    Wanted(17, "truth_beyond", "`crossfix study truth`, each row: error beyond 3 x stated", "%", at_most=0.5),
    Wanted(17, "truth_learned", "time against a search told the true errors, after flights", "%", at_most=5.0),
    Wanted(17, "truth_right", "mean time with a right compass, after flights", "s", at_most=160.0),
    Wanted(17, "demo_time", "demo, whose compass is right: mean time until localized", "s", at_most=160.0),
    Wanted(17, "truth_claimed", "`crossfix study truth`, each row: missions that claim", "%", at_least=98.0),
    # Flying
    Wanted(6, "abort", "abort, request to vehicle command, p99, 50 viewers and 5 stalled", "ms", at_most=100.0),
    Wanted(12, "takeover", "latest flight command after the pilot took over", "ms", at_most=200.0),
    Wanted(18, "takeovers_undone", "takeovers undone, 200 aimed on a real autopilot at 0, 80, 250 ms", "", at_most=0),
    Wanted(18, "takeovers_unnoticed", "takeovers of a real autopilot unnoticed for 1 s", "", at_most=0),
    Wanted(19, "out_of_reach", "500 random stories: vehicle in the air without hold, return, land", "", at_most=0),
    Wanted(19, "stories", "500 random stories: exceptions", "", at_most=0),
    Wanted(13, "links", "console lost, 300 ms and 5 % loss: cases without the stated behaviour", "", at_most=0),
    Wanted(
        13,
        "vehicle_link",
        "vehicle link lost: cases without the stated behaviour",
        "",
        at_most=0,
        test="tests/system/test_faults.py::test_a_vehicle_that_is_gone_is_said_and_the_mission_waits_for_it",
    ),
    Wanted(13, "payload_link", "payload link lost: cases without the stated behaviour", "", at_most=0),
    # Nothing lost
    Wanted(8, "kills", "random kills -9 in flight", "", at_least=1000),
    Wanted(8, "kill_lost", "acknowledged facts lost, doubled or changed by kills", "", at_most=0),
    Wanted(8, "kill_beliefs", "beliefs changed by kills", "", at_most=0),
    Wanted(8, "restart", "restart to HOLD, server forked, at most", "s", at_most=5.0),
    Wanted(21, "start_idle", "whole start to HOLD, idle machine, at most", "s", at_most=2.0),
    Wanted(21, "start_loaded", "whole start to HOLD at load 16, at most", "s", at_most=5.0),
    Wanted(
        21, "hold_order_idle", "whole start to the hold order at the vehicle, idle machine, at most", "s", at_most=2.0
    ),
    Wanted(21, "hold_order_loaded", "whole start to the hold order at the vehicle, load 16, at most", "s", at_most=5.0),
    Wanted(
        9,
        "replay",
        "replayed beliefs that differ on the same build",
        "",
        at_most=0,
        test="tests/backend/api/test_review.py::test_a_past_belief_is_rebuilt_as_it_was",
    ),
    Wanted(9, "replay_elsewhere", "replayed belief on another build, relative difference", "", at_most=1e-9),
    Wanted(15, "outage_minutes", "database away in flight", "min", at_least=10.0),
    Wanted(15, "outage_lost", "facts lost, doubled or changed by an outage of the database", "", at_most=0),
    Wanted(15, "disk_full", "disk full to warning", "s", at_most=2.0),
    Wanted(15, "disk_full_lost", "facts lost, doubled or changed by a full disk", "", at_most=0),
    # Strangers
    Wanted(10, "fuzz_requests", "odd HTTP requests made", "", at_least=100_000),
    Wanted(10, "fuzz_messages", "odd websocket and payload messages sent", "", at_least=100_000),
    Wanted(10, "fuzz_failures", "server errors and crashes under fuzzing", "", at_most=0),
    Wanted(
        11,
        "access",
        "role x endpoint x command pairs not decided by the table of rights",
        "",
        at_most=0,
        test="tests/backend/api/test_permissions.py::test_each_call_lets_in_whom_the_table_says_and_is_written_down",
    ),
    Wanted(6, "half_sent", "an order on a new connection during 1010 half-sent requests, p99", "ms", at_most=100.0),
    Wanted(10, "half_sent_lost", "orders and open pages lost to 1010 half-sent requests", "", at_most=0),
    Wanted(20, "upload_abort", "abort answered while a file of 50 MB is read, at most", "ms", at_most=100.0),
    Wanted(20, "upload_memory", "server's memory above its usual, while a file of 50 MB is read", "MB", at_most=200.0),
    Wanted(20, "upload_answer", "result or refusal of a file of 50 MB, at most", "s", at_most=30.0),
    # Viewers and the page
    Wanted(7, "fanout", "telemetry, publish to read, p99, 100 viewers x 10 Hz and 5 stalled", "ms", at_most=100.0),
    Wanted(7, "fanout_memory", "server's memory over 10 min of it, growth", "%", at_most=1.0),
    Wanted(28, "painted", "bearing to painted belief, median, no graphics card", "ms", at_most=100.0),
    Wanted(16, "page_weight", "whole page, each file gzipped", "kB", at_most=600.0),
    Wanted(
        16,
        "axe",
        "serious findings of axe",
        "",
        at_most=0,
        test="tests/browser/test_page.py::test_the_flight_and_its_sheets_are_legible",
    ),
    Wanted(
        16,
        "page_requests",
        "requests of the page off the machine",
        "",
        at_most=0,
        test="tests/browser/test_page.py::test_no_request_leaves_the_machine",
    ),
    Wanted(21, "page_start", "page usable after a whole start, idle machine", "s", at_most=3.0),
    Wanted(27, "library", "5,000 missions: list, search or open, server time", "ms", at_most=100.0),
    Wanted(27, "library_storage", "storage a bearing after retention", "kB", at_most=10.0),
    # The flight
    Wanted(29, "battery_home", "returns in wind that took no more of the battery than promised", "%", at_least=95.0),
    # Installation
    Wanted(22, "install", "clean machine to two phones and a flown simulated mission", "min", at_most=10.0),
    Wanted(22, "install_commands", "commands and taps for it", "", at_most=10),
)
"""Flat memory is taken as 1 % in ten minutes, linear speed as nine tenths of it."""

BY_KEY = {wanted.key: wanted for wanted in WANTED}
