# SPDX-License-Identifier: GPL-3.0-or-later
"""Insula's messages as ROS 2 messages, without ROS: the fields are those of the official definitions, which the package
rosbags holds. It also packs and unpacks them as ROS does (CDR)."""

import pathlib
import shutil
import subprocess
import sys

import insula
import numpy as np
import pytest
from insula.interchange import ros

rosbags = pytest.importorskip("rosbags", reason="the package rosbags is not installed")
SECOND = 1_000_000


@pytest.fixture(scope="module")
def types(tmp_path_factory):
    """The message classes that lcm-gen makes of lcm_types/."""
    source = pathlib.Path(insula.shipped.folder()) / "lcm_types"
    if not shutil.which("lcm-gen") or not source.is_dir():
        pytest.skip("lcm-gen or lcm_types/ is not here")
    folder = tmp_path_factory.mktemp("types")
    subprocess.run(["lcm-gen", "-p", "--ppath", str(folder), *map(str, sorted(source.glob("*.lcm")))], check=True)
    sys.path.insert(0, str(folder))
    import insula_lcm

    return insula_lcm


@pytest.fixture(scope="module")
def store():
    from rosbags.typesys import Stores, get_typestore

    return get_typestore(Stores.ROS2_HUMBLE)


def packed(store, name, fields):
    """Through the bytes of ROS and back. Every field must be there, and none besides."""
    def make(kind, value):
        declared = dict(store.fielddefs[kind][1])
        assert set(value) == set(declared), kind
        return store.types[kind](**{k: item(declared[k], v) for k, v in value.items()})

    def item(kind, value):
        node, of = int(kind[0]), kind[1]
        if node == 1:  # a basic type
            return value
        if node == 2:  # another message
            return make(of, value)
        inner = of[0]
        if int(inner[0]) == 2:
            return [make(inner[1], v) for v in value]
        if inner[1][0] == "string":
            return list(value)
        return np.frombuffer(value, np.uint8) if isinstance(value, bytes) else np.array(value, inner[1][0])

    message = make(name, fields)
    return store.deserialize_cdr(store.serialize_cdr(message, name), name)


def roundtrip(message):
    return type(message).decode(message.encode())


def devices(types):
    message = types.device_state_t()
    message.time_us, message.hands = 12 * SECOND + 5, 2
    for k in (0, 1):
        hand = types.hand_state_t()
        hand.hand, hand.device, hand.connected = k, "mouse", k == 1
        hand.p_m, hand.q = [0.1, 0.2, 0.3], [0.5, -0.5, 0.1, 0.7]
        hand.v_m_s, hand.w_rad_s = [1, 2, 3], [4, 5, 6]
        hand.force_N, hand.torque_Nm = [0.1, 0, -0.2], [0, 0.01, 0]
        hand.button1, hand.button2 = True, False
        message.hand.append(hand)
    return roundtrip(message)


def frame(types):
    message = types.render_frame_t()
    message.time_us, message.hud_json = 3 * SECOND, "{}"
    body = types.render_body_t()
    body.index, body.nodes, body.x_m = 4, 2, [[0.5, 0, 0.25], [1, 2, 3]]
    message.bodies, message.body, message.body_force_N = 1, [body], [0.5]
    for k, state in enumerate((1, 0)):
        tool = types.render_tool_t()
        tool.index, tool.hand, tool.state, tool.opening_rad = k, k, state, 0.25
        tool.p_m, tool.q = [0.1, 0.2, 0.3], [1, 0, 0, 0]
        message.tool.append(tool)
    message.tools, message.channels, message.channel = 2, 2, [1.5, float("nan")]
    message.contacts, message.contact_x_m, message.contact_N = 1, [[0.25, 0.5, 1]], [0.125]
    message.contact_side = [[0, 1]]
    return roundtrip(message)


def test_hands(types, store):
    messages = ros.device_state(devices(types), offset_ns=2_000_000_000)
    assert {t for t, _, _ in messages} == {"/insula/right/" + n for n in ("pose", "twist", "wrench", "buttons")}
    out = {t.split("/")[-1]: packed(store, name, fields) for t, name, fields in messages}
    stamp = out["pose"].header.stamp
    assert (stamp.sec, stamp.nanosec) == (14, 5000) and out["pose"].header.frame_id == "insula"
    q = out["pose"].pose.orientation
    assert (q.w, q.x, q.y, q.z) == (0.5, -0.5, 0.1, 0.7)
    assert out["twist"].twist.angular.z == 6 and out["wrench"].wrench.force.z == -0.2
    assert list(out["buttons"].buttons) == [1, 0]


def test_frames(types, store):
    messages = {t: packed(store, name, fields) for t, name, fields in ros.render_frame(frame(types), 0, {0: "suction"})}
    transform, = messages["/tf"].transforms  # the tool on the tray is not shown
    assert transform.child_frame_id == "insula/suction" and transform.transform.translation.y == 0.2
    assert list(messages["/insula/joints"].position) == [0.25]
    cloud = messages["/insula/nodes/body_4"]
    assert (cloud.width, cloud.point_step, [f.name for f in cloud.fields]) == (2, 12, ["x", "y", "z"])
    assert np.frombuffer(cloud.data.tobytes(), np.float32).tolist() == [0.5, 0, 0.25, 1, 2, 3]
    contact = messages["/insula/contacts"]
    assert np.frombuffer(contact.data.tobytes(), np.float32).tolist() == [0.25, 0.5, 1, 0.125]
    assert messages["/insula/channels"].data[0] == 1.5 and np.isnan(messages["/insula/channels"].data[1])


def test_events_and_status(types, store):
    event = types.sim_event_t()
    event.kind, event.id, event.text, event.value, event.hand = "fault", "vein", "A vein tore", 2.5, 1
    (_, name, fields), = ros.sim_event(roundtrip(event))
    status, = packed(store, name, fields).status
    assert (status.name, status.hardware_id, status.message) == ("fault", "vein", "A vein tore")
    assert {v.key: v.value for v in status.values} == {"value": "2.5", "sim_time_s": "0.0", "hand": "right"}
    servo = types.haptic_status_t()
    servo.ticks_per_s, servo.note = 999.5, "no real-time scheduling"
    (_, name, fields), = ros.haptic_status(roundtrip(servo))
    status, = packed(store, name, fields).status
    assert status.level == 1 and {v.key: v.value for v in status.values}["ticks_per_s"] == "999.5"


def test_every_mapping_is_of_a_message_that_exists(types):
    for kind, _ in ros.CHANNELS.values():
        assert hasattr(types, kind)


def test_the_way_back(types, store):
    (_, name, fields), = [m for m in ros.device_state(devices(types)) if m[0].endswith("pose")]
    posed = packed(store, name, fields)
    message = roundtrip(ros.hand_input(types.hand_input_t(), "left", posed, 77, (0, 1)))
    assert (message.hand, message.time_us, message.button1, message.button2) == (0, 77, False, True)
    assert np.allclose(message.q, (0.5, -0.5, 0.1, 0.7)) and message.p_m == (0.1, 0.2, 0.3)
    with pytest.raises(ValueError, match='"left" or "right"'):
        ros.hand_input(types.hand_input_t(), "middle", posed, 0)
    posed.header.frame_id = "map"
    with pytest.raises(ValueError, match='frame "map"'):
        ros.hand_input(types.hand_input_t(), "left", posed, 0)


def test_fill_refuses_unknown_fields(store):
    point = store.types["geometry_msgs/msg/Point"](0.0, 0.0, 0.0)
    assert ros.fill(point, {"x": 2.0}, None).x == 2.0
    with pytest.raises(AttributeError, match="no field w"):
        ros.fill(point, {"w": 2.0}, None)


def test_the_node_says_what_it_needs(tmp_path):
    script = pathlib.Path(insula.shipped.folder()) / "examples/python/ros2_bridge.py"
    done = subprocess.run([sys.executable, "-B", str(script), "--types", str(tmp_path)], capture_output=True, text=True,
                          check=False)
    assert done.returncode == 1 and "run ./insula python-types" in done.stderr
    (tmp_path / "insula_lcm").mkdir()
    done = subprocess.run([sys.executable, "-B", "-S", str(script), "--types", str(tmp_path)], capture_output=True,
                          text=True, check=False)
    assert done.returncode == 1 and "needs rclpy" in done.stderr
