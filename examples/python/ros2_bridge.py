#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""A ROS 2 node that passes on a running session: hands, tools, bodies, contacts, events.

    ./insula python-types build/python                          # once
    source /opt/ros/humble/setup.bash
    python3 examples/python/ros2_bridge.py --types build/python [--hand right]

It needs rclpy, of ROS 2, and lcm, of PyPI, in the same Python. With --hand the node also takes
/insula/HAND/wanted (geometry_msgs/PoseStamped) and sends it to the mouse device of the haptic server.
insula.interchange.ros says what becomes of which message.
"""
import argparse
import importlib
import os
import pathlib
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "python"))
DEFAULT_URL = "udpm://239.255.76.67:7667?ttl=0"


def ros_class(name):
    """The class of "geometry_msgs/msg/Pose", or "geometry_msgs/Pose"."""
    package, item = name.split("/")[0], name.split("/")[-1]
    return getattr(importlib.import_module(package + ".msg"), item)


def new_item(message, field):
    """A new item of a list of messages, by the declared type of the field."""
    declared = message.get_fields_and_field_types()[field]  # "sequence<geometry_msgs/Pose>"
    return ros_class(declared[declared.index("<") + 1 : declared.rindex(">")])()


def as_ros(ros, kind, fields):
    """A message of ROS; a diagnostic's level is one byte in Python."""
    for status in fields.get("status", []):
        status["level"] = bytes([status["level"]])
    return ros.fill(ros_class(kind)(), fields, new_item)


class Bridge:
    """Publishers are made when their topic is first used."""

    def __init__(self, node, bus, types, ros, hand):
        self.node, self.bus, self.types, self.ros = node, bus, types, ros
        self.publishers = {}
        for channel, (kind, mapping) in ros.CHANNELS.items():
            bus.subscribe(channel, self.passing(getattr(types, kind), mapping))
        if hand:
            node.create_subscription(ros_class("geometry_msgs/msg/PoseStamped"), "/insula/%s/wanted" % hand,
                                     lambda posed: self.wanted(hand, posed), 10)

    def passing(self, kind, mapping):
        def receive(_channel, data):
            offset = self.node.get_clock().now().nanoseconds - time.monotonic_ns()
            for topic, name, fields in mapping(kind.decode(data), offset):
                if topic not in self.publishers:
                    self.publishers[topic] = self.node.create_publisher(ros_class(name), topic, 10)
                self.publishers[topic].publish(as_ros(self.ros, name, fields))

        return receive

    def wanted(self, hand, posed):
        try:
            message = self.ros.hand_input(self.types.hand_input_t(), hand, posed, time.monotonic_ns() // 1000)
        except ValueError as error:
            self.node.get_logger().warning(str(error))
            return
        self.bus.publish("HAND_INPUT", message.encode())


def main():
    parser = argparse.ArgumentParser(description="passes a running session on to ROS 2")
    parser.add_argument("--types", type=pathlib.Path, required=True, help="folder of ./insula python-types")
    parser.add_argument("--url", default=os.environ.get("LCM_DEFAULT_URL", DEFAULT_URL), help="of the bus")
    parser.add_argument("--hand", choices=("left", "right"), help="hand that ROS moves, through the mouse device")
    options = parser.parse_args()
    if not (options.types / "insula_lcm").is_dir():
        sys.exit("error: %s has no insula_lcm: run ./insula python-types %s" % (options.types, options.types))
    sys.path.insert(0, str(options.types))
    try:
        import lcm
        import rclpy
    except ImportError as error:
        sys.exit("error: %s. The bridge needs rclpy (source the setup of ROS 2) and lcm (pip install lcm)" % error)
    import insula_lcm
    from insula.interchange import ros

    rclpy.init()
    node = rclpy.create_node("insula_bridge")
    bus = lcm.LCM(options.url)
    Bridge(node, bus, insula_lcm, ros, options.hand)
    try:
        while rclpy.ok():
            bus.handle_timeout(5)
            rclpy.spin_once(node, timeout_sec=0)
    except KeyboardInterrupt:
        pass
    node.destroy_node()


if __name__ == "__main__":
    main()
