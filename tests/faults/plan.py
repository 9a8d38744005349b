"""What faults a campaign injects, and when: drawn from the seed alone.

Fault K of a campaign is drawn by a generator seeded with (seed, K). It is therefore the same fault whether the faults
before it are injected or not, and `--seed N --only K` replays it."""
import dataclasses
import random

SERVICES = ("ingest_gateway", "alignment_estimator", "detection_corrector", "ghost_filter", "tracker", "health")
DATA_PATH = ("ingest_gateway", "detection_corrector", "ghost_filter", "tracker")

SECOND_SHARE = 0.25  # of the faults that get a second one while the first lasts or is recovered from
SECOND_WITHIN_S = 1.5
PAUSE_BEFORE_S = (0.1, 0.5)
HOUR_S = 3600


@dataclasses.dataclass(frozen=True)
class Injection:
    """One fault: begins at `at_s` after the first one, lasts `duration_s`. `arguments` are those of its kind."""
    kind: str
    at_s: float
    duration_s: float
    arguments: dict

    def text(self):
        parts = [f"{name}={value}" for name, value in self.arguments.items()]
        if self.duration_s > 0:
            parts.append(f"for {self.duration_s:.2f} s")
        return " ".join([self.kind, *parts])


@dataclasses.dataclass(frozen=True)
class Fault:
    number: int
    pause_s: float  # before it, after the recovery from the one before
    injections: tuple

    def text(self):
        return ", ".join(f"at {i.at_s:.2f} s {i.text()}" if i.at_s > 0 else i.text() for i in self.injections)

    def group(self):
        """Name under which the fault is counted."""
        return self.injections[0].kind if len(self.injections) == 1 else "two faults"


def _service(rng):
    return {"service": rng.choice(SERVICES)}


def _starting(rng):
    return {"service": rng.choice(SERVICES), "again_after_ms": [rng.randint(0, 150) for _ in range(rng.randint(1, 2))]}


def _full(rng):
    return {"killed": rng.choice((*SERVICES, "roudi", "none"))}


# kind: (weight, shortest and longest duration in s, arguments)
KINDS = {
    "kill": (24, (0, 0), _service),
    "terminate": (6, (0, 0), _service),
    "crash": (4, (0, 0), lambda rng: {**_service(rng), "signal": rng.choice(("SIGSEGV", "SIGABRT", "SIGBUS"))}),
    "stop": (9, (0.3, 4), _service),
    "kill_while_starting": (5, (0, 0), _starting),
    "kill_all_services": (2, (0, 0), lambda rng: {}),
    "kill_roudi": (6, (0, 0), lambda rng: {"process": rng.choice(("roudi", "wrapper"))}),
    "stop_roudi": (4, (0.3, 3), lambda rng: {}),
    "kill_supervisor": (4, (0, 2), lambda rng: {}),
    "stop_input": (5, (0.3, 3), lambda rng: {}),
    "kill_input": (3, (0, 1.5), lambda rng: {}),
    "hog": (4, (1, 3), lambda rng: {"busy_per_core": rng.choice((1, 2, 4))}),
    "clock_step": (6, (0.5, 2), lambda rng: {"step_s": rng.choice((-HOUR_S, HOUR_S))}),
    "stranger_samples": (4, (1, 2.5), lambda rng: {}),
    "stranger_bytes": (4, (0.5, 2), lambda rng: {"seed": rng.randrange(1 << 30)}),
    "bad_input": (3, (6, 8), lambda rng: {"damage": rng.choice(("damaged", "empty", "frozen")),
                                          "radar": rng.randint(1, 4)}),
    "full_state": (4, (1.2, 2.5), _full),
    "full_logs": (3, (0.5, 2), _full),
    "full_shared_memory": (2, (0.5, 2), _full),
    "power_cut": (5, (0, 0), lambda rng: {"memory": rng.choice(("cleared", "kept")), "after_ms": rng.randint(0, 1200),
                                          "within_write": rng.random() < 0.5}),
    "broken_configuration": (5, (0.8, 2.5), lambda rng: {
        **_service(rng), "damage": rng.choice(("syntax", "unknown_key", "removed", "vehicle_emptied", "folder"))}),
}
# What a second fault may be: kinds that do not restart the whole product by hand.
SECOND_KINDS = ("kill", "terminate", "crash", "stop", "kill_roudi", "stop_input", "hog", "clock_step", "stranger_samples")


def _injection(rng, kind, at_s):
    _, (shortest_s, longest_s), arguments = KINDS[kind]
    return Injection(kind, round(at_s, 2), round(rng.uniform(shortest_s, longest_s), 2), arguments(rng))


def draw(seed, number, kinds=None):
    """Fault `number` of the campaign `seed`. `kinds`: only these; default all, by their weights."""
    rng = random.Random(f"{seed}:{number}")
    pause_s = round(rng.uniform(*PAUSE_BEFORE_S), 2)
    names = [name for name in KINDS if not kinds or name in kinds]
    first = _injection(rng, rng.choices(names, [KINDS[name][0] for name in names])[0], 0)
    if kinds or rng.random() >= SECOND_SHARE:
        return Fault(number, pause_s, (first,))
    names = [name for name in SECOND_KINDS if name != first.kind or name == "kill"]
    kind = rng.choices(names, [KINDS[name][0] for name in names])[0]
    at_s = rng.uniform(0, max(SECOND_WITHIN_S, first.duration_s))
    return Fault(number, pause_s, (first, _injection(rng, kind, at_s)))
