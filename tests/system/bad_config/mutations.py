"""Mutations of the shipped configuration: each one change of one file, and the begin of the message that it must cause."""
import dataclasses
import re
import typing

SERVICES = ("ingest_gateway", "alignment_estimator", "detection_corrector", "ghost_filter", "tracker", "health")
VEHICLE = "vehicle/demo.toml"
MIXED = "vehicle/example_mixed.toml"


@dataclasses.dataclass
class Mutation:
    name: str
    file: str
    services: tuple
    expected: typing.Optional[str]  # begin of "key: problem"; None: the file is allowed
    change: typing.Optional[typing.Callable] = None  # bytes to bytes
    special: str = ""  # kind of what takes the file's place
    vehicle: str = "demo"
    at_change: bool = True  # the message names the changed line


ALL = []


def replaced(old, new):
    def change(text):
        assert old.encode() in text, f"{old!r} is not in the shipped file"
        return text.replace(old.encode(), new.encode(), 1)
    return change


def add(file, services, *changes, vehicle="demo"):
    """Each change is (old, new, expected); an expected text that begins with ~ may be at another line."""
    for old, new, expected in changes:
        at_change = not (expected or "").startswith("~")
        ALL.append(Mutation(f"{file}: {old!r:.50} → {new!r:.50}", file, services, expected and expected.lstrip("~"),
                            replaced(old, new), vehicle=vehicle, at_change=at_change))


def add_text(name, expected, change, file=VEHICLE, services=("ingest_gateway", "health"), at_change=False):
    ALL.append(Mutation(name, file, services, expected, change, at_change=at_change))


def add_values(service, *changes):
    """Each change is (key, value, expected key): the first assignment of that key in the service's file."""
    for key, value, expected in changes:
        pattern = re.compile(rb"^" + key.encode() + rb" = (\[[^\]]*\]|\S+)", re.M)

        def change(text, pattern=pattern, key=key, value=value):
            assert pattern.search(text), f"no {key} in the shipped file"
            return pattern.sub(f"{key} = {value}".encode(), text, count=1)
        file = f"services/{service}.toml"
        reader = "tracker" if service == "object_classes" else service
        ALL.append(Mutation(f"{file}: {key} = {value}", file, (reader,), expected and f"{expected}: ", change))


# Vehicle: names, ids, counts.
add(VEHICLE, ("ingest_gateway", "health"),
    ('name = "demo"\n', "", "~name: is missing"),
    ('name = "demo"', "name = 5", "name: must be a string"),
    ('name = "demo"', 'name = ""', "name: must have 1"),
    ('name = "demo"', 'name = "a\\nb\\u001b[2Jc"', "name: must not contain control characters"),
    ('name = "demo"', f'name = "{"x" * 100_000}"', "name: must have 1"),
    ('name = "front_left"', 'name = "f\\nl\\u001b[2J"', "radar[0].name: must not contain control characters"),
    ('name = "front_left"', f'name = "{"x" * 32}"', "radar[0].name: must have 1"),
    ('name = "front_left"', 'name = ""', "radar[0].name: must have 1"),
    ('name = "front_left"', 'name = "   "', "radar[0].name: must not begin or end with a blank"),
    ("id = 1\n", "id = 0\n", "radar[0].id: 0 is out of range"),
    ("id = 1\n", "id = 17\n", "radar[0].id: 17 is out of range"),
    ("id = 1\n", "id = -1\n", "radar[0].id: -1 is out of range"),
    ("id = 1\n", "id = 4294967297\n", "radar[0].id: 4294967297 is out of range"),
    ("id = 1\n", "id = 9223372036854775808\n", "not valid TOML"),
    ("id = 1\n", "id = 1.0\n", "radar[0].id: must be an integer"),
    ("id = 1\n", 'id = "1"\n', "radar[0].id: must be an integer"),
    ("id = 1\n", "id = 0x1\n", None),
    ("id = 2\n", "id = 1\n", "radar[1].id: 1 is already used by front_left"),
    ('"front_right"', '"front_left"', 'radar[1].name: "front_left" is already used'),
    ('name = "demo"', 'name = "demo"\nnaem = 1', "naem: unknown key; similar: 'name'"),
    ("yaw_deg = 45.0}", "yaw_deg = 45.0, yaw_degree = 3}", "radar[0].mounting_pose.yaw_degree: unknown key"),
    ("id = 1\n", "id = 1\nid = 1\n", "not valid TOML"))
# Mounting and field of view.
add(VEHICLE, ("ingest_gateway",),
    ("yaw_deg = 45.0", "yaw_deg = nan", "radar[0].mounting_pose.yaw_deg: nan is out of range"),
    ("yaw_deg = 45.0", "yaw_deg = inf", "radar[0].mounting_pose.yaw_deg: inf is out of range"),
    ("yaw_deg = 45.0", "yaw_deg = 1e400", "not valid TOML"),
    ("yaw_deg = 45.0", "yaw_deg = 180.0001", "radar[0].mounting_pose.yaw_deg: 180 is out of range"),
    ("yaw_deg = 45.0", 'yaw_deg = "45"', "radar[0].mounting_pose.yaw_deg: must be a number"),
    ("yaw_deg = 45.0", "yaw_deg = true", "radar[0].mounting_pose.yaw_deg: must be a number"),
    ("yaw_deg = 45.0", "yaw_deg = 2020-01-01", "radar[0].mounting_pose.yaw_deg: must be a number"),
    ("yaw_deg = 45.0", "yaw_deg = 0.785", None),
    ("[3.65, 0.75, 0.6]", "[nan, 0.75, 0.6]", "radar[0].mounting_pose.position_m: element 1"),
    ("[3.65, 0.75, 0.6]", "[3.65, 0.75]", "radar[0].mounting_pose.position_m: has 2 elements"),
    ("[3.65, 0.75, 0.6]", "[31.0, 0.75, 0.6]", "radar[0].mounting_pose.position_m: element 1"),
    ("[3.65, -0.75, 0.6], yaw_deg = -45.0", "[3.65, 0.75, 0.6], yaw_deg = 45.0",
     "radar[1].mounting_pose: is that of front_left too"),
    ("[3.65, -0.75, 0.6], yaw_deg = -45.0", "[3.655, 0.75, 0.6], yaw_deg = 45.5",
     "radar[1].mounting_pose: is that of front_left too"),
    ("[3.65, -0.75, 0.6], yaw_deg = -45.0", "[3.65, 0.75, 0.7], yaw_deg = 45.0", None),
    ("azimuth_min_deg = -70.0, azimuth_max_deg = 70.0", "azimuth_min_deg = 70.0, azimuth_max_deg = -70.0",
     "radar[0].field_of_view.azimuth_min_deg: must be below azimuth_max_deg"),
    ("azimuth_min_deg = -70.0, azimuth_max_deg = 70.0", "azimuth_min_deg = 70.0, azimuth_max_deg = 70.0",
     "radar[0].field_of_view.azimuth_min_deg: must be below azimuth_max_deg"),
    ("elevation_min_deg = -18.0", "elevation_min_deg = 18.0", "radar[0].field_of_view.elevation_min_deg: must be below"),
    ("range_max_m = 100.0", "range_max_m = inf", "radar[0].field_of_view.range_max_m: inf is out of range"))
# Times, noise, tolerances.
add(VEHICLE, ("ingest_gateway", "health"),
    ("cycle_time_s = 0.05", "cycle_time_s = 0.0", "radar[0].cycle_time_s: 0 is out of range"),
    ("cycle_time_s = 0.05", "cycle_time_s = 50", "radar[0].cycle_time_s: 50 is out of range"),
    ("deadline_s = 0.25", "deadline_s = 0.04", "radar[0].deadline_s: must be longer than cycle_time_s"),
    ("deadline_s = 0.25", "deadline_s = 10.1", "radar[0].deadline_s: 10.1 is out of range"),
    ("azimuth_std_deg = 0.3", "azimuth_std_deg = 0.0", "radar[0].noise.azimuth_std_deg: 0 is out of range"),
    ("range_std_m = 0.15", "range_std_m = -0.15", "radar[0].noise.range_std_m: -0.15 is out of range"),
    ("tolerance = {yaw_deg = 1.5", "tolerance = {yaw_deg = 45", "radar[0].tolerance.yaw_deg: 45 is out of range"),
    ("tolerance = {yaw_deg = 1.5", "tolerance = {yaw_deg = 0", "radar[0].tolerance.yaw_deg: 0 is out of range"),
    ("tolerance = {yaw_deg = 1.5", "tolerance = {yaw_deg = -1.5", "radar[0].tolerance.yaw_deg: -1.5 is out of range"),
    ("roll_deg = 3.0}", "roll_deg = 90}", "radar[0].tolerance.roll_deg: 90 is out of range"),
    ("limit = {yaw_deg = 3.0", "limit = {yaw_deg = 45", "radar[0].limit.yaw_deg: 45 is out of range"),
    ("limit = {yaw_deg = 3.0", "limit = {yaw_deg = 1.5", "radar[0].limit.yaw_deg: must be above the tolerance"),
    ("roll_deg = 6.0}", "roll_deg = 2.0}", "radar[0].limit.roll_deg: must be above the tolerance"),
    ("limit = {yaw_deg = 3.0", "limits = {yaw_deg = 3.0", "radar[0].limits: unknown key"),
    ("speed_std_mps = 0.03", "speed_std_mps = 0", "ego.speed_std_mps: 0 is out of range"))
# Sources.
add(VEHICLE, ("ingest_gateway",),
    ('profile = "ars548"', 'profile = "ars549"', 'radar[0].profile: "ars549" is unknown'),
    ('profile = "ars548"', 'profile = "ARS548"', 'radar[0].profile: "ARS548" is unknown'),
    ('profile = "ars548"', 'profile = "ars408"', '~radar[0].source: this profile needs link = "can"'),
    ("10.13.1.114", "10.13.1.113", "radar[1].source: is the source of front_left too"),
    ("10.13.1.114", "::ffff:10.13.1.113", "radar[1].source: is the source of front_left too"),
    ("10.13.1.114", "10.13.01.113", "radar[1].source.sender:"),
    (', sender = "10.13.1.113"', "", "~radar[1].source: is the source of front_left too"),
    ('"10.13.1.113"', '""', "radar[0].source.sender:"),
    ('"10.13.1.113"', '"224.0.0.9"', 'radar[0].source.sender: "224.0.0.9" is not the address of one host'),
    ('"10.13.1.113"', '"0.0.0.0"', 'radar[0].source.sender: "0.0.0.0" is not the address of one host'),
    ('"10.13.1.113"', '"fd00::1"', "radar[0].source.sender: must be of the same IP version"),
    ("port = 42102", "port = 0", "radar[0].source.port: 0 is out of range"),
    ("port = 42102", "port = 65536", "radar[0].source.port: 65536 is out of range"),
    (", port = 42102", "", "radar[0].source.port: is missing; allowed: 1 … 65535"),
    ("224.0.2.2", "300.1.1.1", 'radar[0].source.address: "300.1.1.1" is neither'),
    ("224.0.2.2", "radar.local", 'radar[0].source.address: "radar.local" is neither'),
    ('"224.0.2.2"', '""', 'radar[0].source.address: "" is neither'),
    ('address = "224.0.2.2", ', "", "radar[0].source.address: is missing"),
    (', interface = "can0"', "", "ego.source.interface: is missing"),
    ('interface = "can0"', 'interface = ""', "ego.source.interface: must be a network interface's name"),
    ('interface = "can0"', 'interface = "can0123456789012345"', "ego.source.interface: must be a network interface's name"),
    ('interface = "can0"', 'interface = "../can0"', "ego.source.interface: must be a network interface's name"))
add(MIXED, ("ingest_gateway",),
    ("instance = 2}", "instance = 3}", "~radar[2].source: is the source of front_left too"),
    (", instance = 2}", "}", "radar[1].source.instance: is missing"),
    ('"10.13.1.2"', '"0.0.0.0"', 'radar[1].source.address: "0.0.0.0" is not the address of one host'),
    (', discovery_address = "ff14::4:c0"', "", "radar[2].source.discovery_address: must be of the same IP version"),
    ('"ff14::4:c0"', '"fd00::9"', 'radar[2].source.discovery_address: "fd00::9" must be a multicast group'),
    ("instance = 2}", "instance = 2, port = 30490}", "radar[1].source.port: is the port of service discovery"),
    ("sensor_id = 1", "sensor_id = 0", "~radar[5].source: is the source of rear_right too"),
    ('interface = "eth0"}\nego', 'interface = "eth 0"}\nego', "radar[0].source.interface: must be a network interface's"),
    ('mapping = "../mappings/example_radar.toml"', 'mapping = ""', "radar[6].mapping: must be"), vehicle="example_mixed")


# Whole texts.
def without_radars(text):
    return text.split(b"[[radar]]")[0]


def with_seventeen_radars(text):
    radar = ('\n[[radar]]\nid = {0}\nname = "r{0}"\nprofile = "ars548"\nsource = {{link = "udp", address = "224.0.2.2", port = '
             '42102, sender = "10.13.1.{0}"}}\nmounting_pose = {{position_m = [0.0, 0.0, 0.{0}], yaw_deg = 0.0}}\n')
    return text + "".join(radar.format(i) for i in range(5, 18)).encode()


add_text("no radar", "radar: is missing", without_radars)
add_text("radar = []", "radar: has 0 tables; their number must be 1",
         lambda text: without_radars(text).replace(b'"demo"\n', b'"demo"\nradar = []\n', 1))
add_text("radar is a table", "radar: must be an array of tables", lambda text: without_radars(text) + b"[radar]\nid = 1\n")
add_text("17 radars", "radar: has 17 tables; their number must be 1", with_seventeen_radars)
add_text("unknown table", "rader: unknown key; similar: 'radar'", lambda text: text + b"\n[rader]\nid = 9\n")
add_text("empty file", "name: is missing", lambda text: b"")
add_text("UTF-16", "not valid TOML", lambda text: text.decode().encode("utf-16"))
add_text("carriage returns only", "not valid TOML", lambda text: text.replace(b"\n", b"\r"))
add_text("NUL byte", "not valid TOML", lambda text: text + b"\0")
add_text("cut in the middle", "not valid TOML", lambda text: text[:len(text) // 2 - 40])
add_text("conflict marker", "not valid TOML", lambda text: b"<<<<" + b"<<< HEAD\n" + text)
add_text("typographic quotes", "not valid TOML", replaced('"demo"', "\u201cdemo\u201d"))
add_text("arrays 100,000 deep", "not valid TOML", lambda text: text + b"\nx = " + b"[" * 100_000 + b"]" * 100_000 + b"\n")
add_text("inline tables 5,000 deep", "not valid TOML", lambda text: text + b"\nx = " + b"{a=" * 5000 + b"1" + b"}" * 5000 + b"\n")
add_text("100,000 unknown keys", "radar[3].k0: unknown key",
         lambda text: text + "".join(f"k{i} = 1\n" for i in range(100_000)).encode())
add_text("byte order mark", None, lambda text: b"\xef\xbb\xbf" + text)
add_text("CR LF", None, lambda text: text.replace(b"\n", b"\r\n"))
add_text("tabulators", None, replaced('name = "demo"', '\tname\t=\t"demo"'))
add_text("comment of 1 MB", None, lambda text: b"# " + b"x" * 1_000_000 + b"\n" + text)

# What is no regular file, or too large, in place of each file that a service reads.
KINDS = (("absent", "No such file"), ("pipe", "it is a pipe; must be a regular file"), ("folder", "it is a folder; must be a regular file"),
         ("socket", "it is a socket; must be a regular file"), ("/dev/zero", "it is a device; must be a regular file"),
         ("/dev/null", "it is a device; must be a regular file"), ("large", "it is larger than "),
         ("link to itself", "Too many levels of symbolic links"))


def add_special(file, services, vehicle="demo"):
    for kind, expected in KINDS:
        if kind == "absent" and file == VEHICLE:
            continue  # the message lists the names of vehicles: tests of the options
        ALL.append(Mutation(f"{file} is {kind}", file, services, expected, special=kind, vehicle=vehicle))


add_special(VEHICLE, SERVICES)
for name in (*SERVICES, "replay"):
    add_special(f"services/{name}.toml", (name,))
add_special("services/object_classes.toml", ("tracker",))
add_special("services/object_forest.csv", ("tracker",))
add("services/object_forest.csv", ("tracker",),
    ("version,1", "version,2", "the version must be 1"), ("number,memory_s", "number,memory", "the number must be memory_s"),
    ("feature,count_rate", "feature,counts", "the feature must be count_rate"))
add_special("radar_profiles/ideal.toml", ("ghost_filter",))
for name in ("example_radar.toml", "example_ego.toml", "example_radar.dbc"):
    add_special(f"mappings/{name}", ("ingest_gateway",), "example_mixed")

# Services: nonsense, and values that switch a verdict off.
add_values("health",
           ("window_s", "0", "supervision.window_s"), ("window_s", "nan", "supervision.window_s"),
           ("min_rate_ratio", "0.0", "supervision.min_rate_ratio"), ("min_rate_ratio", "1.5", "supervision.min_rate_ratio"),
           ("max_rejected_ratio", "1.0", "supervision.max_rejected_ratio"),
           ("max_suspect_ratio", "1.0", "supervision.max_suspect_ratio"),
           ("latency_budget_s", "0.0", "supervision.latency_budget_s"), ("blind_ratio", "0.9", "sight.blind_ratio"),
           ("least_detections", "0", "sight.least_detections"), ("least_range_m", "nan", "sight.least_range_m"),
           ("least_share", "1.0", "disturbance.least_share"), ("least_log_std", "0", "disturbance.least_log_std"),
           ("neighbour_distance_m", "1e9", "disturbance.neighbour_distance_m"), ("write_period_s", "0", "learnt_levels.write_period_s"),
           ("first_write_s", "0", "learnt_levels.first_write_s"),
           ("max_late_ratio", "1.0", "pipeline.max_late_ratio"),
           ("queueing_budget_s", "5", "pipeline.queueing_budget_s"), ("max_lost_ratio", "-0.1", "pipeline.max_lost_ratio"),
           ("max_work_budget_ratio", "nan", "pipeline.max_work_budget_ratio"),
           ("confidence", "0.5", "misalignment.confidence"), ("confidence", "1.0", "misalignment.confidence"), ("set_s", "600", "misalignment.set_s"),
           ("clear_ratio", "1.0", "misalignment.clear_ratio"), ("domain", "233", "dds.domain"), ("domain", "-1", "dds.domain"),
           ("interfaces", '["ban/ana"]', "dds.interfaces"), ("interfaces", '["10.0.0.256"]', "dds.interfaces"),
           ("interfaces", '[]', "dds.interfaces"), ("interfaces", '["all", "eth0"]', "dds.interfaces"),
           ("interfaces", '[""]', "dds.interfaces"), ("interfaces", '["0.0.0.0"]', "dds.interfaces"),
           ("interfaces", '["224.0.0.1"]', "dds.interfaces"), ("interfaces", '["fd00::1"]', "dds.interfaces"),
           ("interfaces", '["10.0.0.1", "10.0.0.1"]', "dds.interfaces"), ("interfaces", '"10.0.0.1"', "dds.interfaces"),
           ("interfaces", '["10.0.0.1", 3]', "dds.interfaces"), ("interfaces", '["10.0.0.1", "eth0"]', None), ("interfaces", '["all"]', None),
           ("period_s", "1e9", "dds.period_s"), ("farewell_s", "3.0", "dds.farewell_s"), ("tracks_period_s", "-0.1", "dds.tracks_period_s"),
           ("tracks_period_s", "nan", "dds.tracks_period_s"), ("tracks_period_s", "0.0", None), ("tracks", "1", "dds.tracks"), ("tracks", "false", None), ("enabled", '"yes"', "fault_memory.enabled"), ("enabled", "false", None),
           ("ageing_cycles", "0", "fault_memory.ageing_cycles"), ("operation_cycle", '"drive"', "fault_memory.operation_cycle"),
           ("start_grace_s", "0", "supervision.start_grace_s"),
           ("directory", '"keys"', "dds.security.directory"), ("directory", '"/absent"', None), ("governance", "5", "dds.security.governance"))
add_values("tracker",
           ("probability", "nan", "detection.probability"), ("probability", "0", "detection.probability"),
           ("confirmed_existence", "0.015", "report.confirmed_existence"),
           ("group_objects", "250", None), ("group_objects", "257", "capacity.group_objects"),
           ("band_half_width_m", "nan", "road_edge.band_half_width_m"), ("warning_probability", "0", "collision.warning_probability"),
           ("corridor_m", "0", "path_obstacle.corridor_m"), ("tracker", '"pmbmm"', "tracker"))
add_values("object_classes", ("prior_share", "[1, 1, 1, 1, 1]", "prior_share"), ("length_mean_m", "[1, 2]", "size.length_mean_m"))
add_values("detection_corrector",
           ("min_m", "[300.0, -60.0, -2.0]", "region_of_interest.min_m"), ("min_m", "[nan, -60.0, -2.0]", "region_of_interest.min_m"),
           ("min_m", "[199.9, -60.0, -2.0]", "region_of_interest.min_m"), ("near_dbsm", "100.0", "rcs_threshold.near_dbsm"),
           ("sigma", "0", "moving.sigma"), ("sigma", "20.0", "moving.sigma"),
           ("body_motion_std_mps", "10.0", "moving.body_motion_std_mps"), ("alignment_max_age_s", "0.0", "side_inputs.alignment_max_age_s"))
add_values("alignment_estimator",
           ("method", '"boresite"', "method"), ("publish_period_s", "0", "publish_period_s"),
           ("publish_period_s", "1e-9", "publish_period_s"), ("publish_period_s", "10.0", "publish_period_s"),
           ("truth_file", '"/nowhere.csv"', "truth_file"), ("truth_file", '"/dev/zero"', "truth_file"),
           ("path", '"/tmp"', "memory.path"), ("path", '"/dev/null"', "memory.path"),
           ("prior_log_odds", "100.0", "plausibility.prior_log_odds"), ("margin_log", "100.0", "plausibility.margin_log"),
           ("doubt_s", "0.0", "filter.remembered.doubt_s"), ("stop_s", "-1.0", "filter.remembered.stop_s"),
           ("min_inlier_share", "1.0", "filter.convergence.min_inlier_share"), ("passes", "1000000", "filter.start.passes"),
           ("interface", '"a/b"', "station.interface"), ("address", '"banana"', "station.address"),
           ("discovery_group", '"banana"', "station.discovery_group"))
add_values("ghost_filter",
           ("method", '"mirrors"', "method"), ("min_cells", "-1", "evidence.map.min_cells"),
           ("least_mirror_share", "0.7", "evidence.intensity.least_mirror_share"), ("memory_s", "inf", "published.reflectors.memory_s"),
           ("past_scans", "[1, 3, 2, 5, 7]", "evidence.levels.past_scans"))
add_values("ingest_gateway",
           ("false_alarm", "0.0", "contradiction.false_alarm"), ("least_share", "0.5", "contradiction.least_share"),
           ("input", '"life"', "input"), ("input", '""', "input"), ("tunnel_path", f'"/tmp/{"x" * 200}"', "tunnel_path"))
add_values("replay",
           ("tunnel_path", f'"/tmp/{"x" * 200}"', "tunnel_path"), ("discovery_group", '"10.0.0.1"', "someip.discovery_group"),
           ("first_port", "80", "someip.first_port"))
add_text("a route to a name", 'route[0].local: "gateway" is neither',
         lambda text: text + b'\n[[route]]\nrecorded = "224.0.2.2"\nlocal = "gateway"\n', "services/replay.toml", ("replay",))
add_text("two routes of one address", 'route[1].recorded: "224.0.2.2" must have one route only',
         lambda text: text + 2 * b'\n[[route]]\nrecorded = "224.0.2.2"\nlocal = "127.0.0.1"\n', "services/replay.toml", ("replay",))
add_text("fewer objects than a group has", "capacity.group_objects: must not exceed objects",
         replaced("\nobjects = 384", "\nobjects = 100"), "services/tracker.toml", ("tracker",))
add_text("a step that is never reported", "filter.step_change.yaw_deg: 30 is out of range",
         replaced("yaw_deg = 0.45 ", "yaw_deg = 30.0 "), "services/alignment_estimator.toml", ("alignment_estimator",), True)
add_text("no interface for the station", "station.interface: is empty",
         lambda text: text.replace(b"\nenabled = false", b"\nenabled = true", 1), "services/alignment_estimator.toml", ("alignment_estimator",))
