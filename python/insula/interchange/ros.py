# SPDX-License-Identifier: GPL-3.0-or-later
"""Insula's LCM messages as ROS 2 messages: a pure mapping, without ROS.

Each function takes a decoded message of lcm_types/ and returns a list of (topic, ROS type, fields). Fields are numbers,
texts, bytes, lists and dictionaries by the names of the ROS type. `fill` puts them into an object of that type.
`examples/python/ros2_bridge.py` is the node that does so.

Times of the bus count CLOCK_MONOTONIC. `offset_ns` is what takes them to the clock of ROS. ROS has x y z w for
quaternions, Insula w x y z. The frame is "insula": metres, in the axes of the scene.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Sequence
from typing import Any

FRAME = "insula"
HANDS = ("left", "right")
Message = tuple[str, str, dict[str, Any]]
FLOAT32 = 7  # sensor_msgs/PointField


def stamp(time_us: int, offset_ns: int = 0) -> dict[str, int]:
    """builtin_interfaces/Time."""
    sec, nanosec = divmod(1000 * int(time_us) + offset_ns, 10**9)
    return {"sec": sec, "nanosec": nanosec}


def header(message: Any, offset_ns: int, frame: str = FRAME) -> dict[str, Any]:
    return {"stamp": stamp(message.time_us, offset_ns), "frame_id": frame}


def vector(values: Sequence[float]) -> dict[str, float]:
    x, y, z = (float(v) for v in values)
    return {"x": x, "y": y, "z": z}


def quaternion(q: Sequence[float]) -> dict[str, float]:
    """Of w x y z."""
    w, x, y, z = (float(v) for v in q)
    return {"x": x, "y": y, "z": z, "w": w}


def pose(p: Sequence[float], q: Sequence[float]) -> dict[str, Any]:
    return {"position": vector(p), "orientation": quaternion(q)}


def hand_name(hand: int) -> str:
    """Raises ValueError for what is no hand."""
    if hand not in (0, 1):
        raise ValueError("hand %r: 0 is the left hand and 1 the right one" % (hand,))
    return HANDS[hand]


def device_state(message: Any, offset_ns: int = 0) -> list[Message]:
    """device_state_t: pose, twist, wrench and buttons of each connected hand."""
    out: list[Message] = []
    for hand in message.hand:
        if not hand.connected:
            continue
        topic, head = "/insula/%s/" % hand_name(hand.hand), header(message, offset_ns)
        out += [
            (topic + "pose", "geometry_msgs/msg/PoseStamped", {"header": head, "pose": pose(hand.p_m, hand.q)}),
            (topic + "twist", "geometry_msgs/msg/TwistStamped",
             {"header": head, "twist": {"linear": vector(hand.v_m_s), "angular": vector(hand.w_rad_s)}}),
            (topic + "wrench", "geometry_msgs/msg/WrenchStamped",
             {"header": head, "wrench": {"force": vector(hand.force_N), "torque": vector(hand.torque_Nm)}}),
            (topic + "buttons", "sensor_msgs/msg/Joy",
             {"header": head, "axes": [], "buttons": [int(hand.button1), int(hand.button2)]}),
        ]
    return out


def point_cloud(head: dict[str, Any], fields: Sequence[str], rows: Sequence[Sequence[float]]) -> dict[str, Any]:
    """sensor_msgs/PointCloud2 of float32 fields, packed by rows."""
    size = 4 * len(fields)
    data = b"".join(struct.pack("<%df" % len(fields), *row) for row in rows)
    return {
        "header": head, "height": 1, "width": len(rows), "is_bigendian": False, "point_step": size,
        "row_step": size * len(rows), "is_dense": True, "data": data,
        "fields": [{"name": name, "offset": 4 * k, "datatype": FLOAT32, "count": 1} for k, name in enumerate(fields)],
    }


def render_frame(message: Any, offset_ns: int = 0, names: dict[int, str] | None = None) -> list[Message]:
    """render_frame_t: poses and openings of tools, nodes of bodies, contacts, channels. `names`: of tools and bodies by
    their index in the scene bundle; otherwise they are called tool_3 and body_0."""
    known, head = names or {}, header(message, offset_ns)
    tools = [(known.get(t.index, "tool_%d" % t.index), t) for t in message.tool if t.state != 0]
    transforms = [{"header": head, "child_frame_id": "%s/%s" % (FRAME, name), "transform": {
        "translation": vector(t.p_m), "rotation": quaternion(t.q)}} for name, t in tools]
    out: list[Message] = [
        ("/tf", "tf2_msgs/msg/TFMessage", {"transforms": transforms}),
        ("/insula/joints", "sensor_msgs/msg/JointState", {
            "header": head, "name": [name for name, _ in tools],
            "position": [float(t.opening_rad) for _, t in tools], "velocity": [], "effort": []}),
        ("/insula/contacts", "sensor_msgs/msg/PointCloud2", point_cloud(
            head, ("x", "y", "z", "force"), [(*x, n) for x, n in zip(message.contact_x_m, message.contact_N)])),
        ("/insula/channels", "std_msgs/msg/Float32MultiArray", {
            "layout": {"dim": [{"label": "channel", "size": len(message.channel), "stride": len(message.channel)}],
                       "data_offset": 0}, "data": [float(x) for x in message.channel]}),
    ]
    for body in message.body:
        name = known.get(body.index, "body_%d" % body.index)
        out.append(("/insula/nodes/" + name, "sensor_msgs/msg/PointCloud2",
                    point_cloud(head, ("x", "y", "z"), body.x_m)))
    return out


def sim_event(message: Any, offset_ns: int = 0) -> list[Message]:
    """sim_event_t as one diagnostic: what happened, of what, and its value."""
    values = {"value": repr(float(message.value)), "sim_time_s": repr(float(message.sim_time_s))}
    if message.hand in (0, 1):
        values["hand"] = hand_name(message.hand)
    return [("/insula/events", "diagnostic_msgs/msg/DiagnosticArray", {
        "header": header(message, offset_ns),
        "status": [diagnostic(0, message.kind, message.text, message.id, values)]})]


def haptic_status(message: Any, offset_ns: int = 0) -> list[Message]:
    """haptic_status_t as one diagnostic; a warning where the servo gives advice."""
    values = {k: repr(getattr(message, k)) for k in (
        "ticks_per_s", "missed_ticks", "lateness_us_p50", "lateness_us_p99", "lateness_us_max", "solve_us_p50",
        "solve_us_p99", "rows", "problem_age_ms", "messages_refused", "force_scale", "realtime")}
    level = 1 if message.note else 0
    return [("/diagnostics", "diagnostic_msgs/msg/DiagnosticArray", {
        "header": header(message, offset_ns),
        "status": [diagnostic(level, "insula: haptic_server", message.note or "well", "haptic_server", values)]})]


def diagnostic(level: int, name: str, text: str, hardware: str, values: dict[str, str]) -> dict[str, Any]:
    return {"level": level, "name": name, "message": text, "hardware_id": hardware,
            "values": [{"key": k, "value": v} for k, v in values.items()]}


# By channel: type of the LCM message, and its mapping.
CHANNELS: dict[str, tuple[str, Callable[..., list[Message]]]] = {
    "DEVICE_STATE": ("device_state_t", device_state),
    "RENDER_FRAME": ("render_frame_t", render_frame),
    "SIM_EVENT": ("sim_event_t", sim_event),
    "HAPTIC_STATUS": ("haptic_status_t", haptic_status),
}


def hand_input(target: Any, hand: str, posed: Any, time_us: int, buttons: Sequence[int] = (0, 0)) -> Any:
    """The way back: a geometry_msgs/PoseStamped as hand_input_t, for the haptic server's mouse device. `target`: an
    empty hand_input_t, which is filled and returned."""
    if hand not in HANDS:
        raise ValueError('hand "%s": "left" or "right"' % hand)
    if posed.header.frame_id not in ("", FRAME):
        raise ValueError('the pose is in the frame "%s"; "%s" is wanted' % (posed.header.frame_id, FRAME))
    p, q = posed.pose.position, posed.pose.orientation
    norm = (q.w**2 + q.x**2 + q.y**2 + q.z**2) ** 0.5
    if not 0.99 < norm < 1.01:
        raise ValueError("the orientation is no unit quaternion: its norm is %g" % norm)
    target.time_us, target.hand = int(time_us), HANDS.index(hand)
    target.p_m = [p.x, p.y, p.z]
    target.q = [q.w / norm, q.x / norm, q.y / norm, q.z / norm]
    target.button1, target.button2 = (bool(b) for b in buttons[:2])
    return target


def fill(message: Any, fields: dict[str, Any], make: Callable[[Any, str], Any]) -> Any:
    """Puts fields into a ROS message, and returns it. `make(message, name)`: a new item of the list `name`."""
    for name, value in fields.items():
        if not hasattr(message, name):
            raise AttributeError("%s has no field %s" % (type(message).__name__, name))
        if isinstance(value, dict):
            fill(getattr(message, name), value, make)
        elif isinstance(value, list) and value and isinstance(value[0], dict):
            setattr(message, name, [fill(make(message, name), item, make) for item in value])
        else:
            setattr(message, name, value)
    return message
