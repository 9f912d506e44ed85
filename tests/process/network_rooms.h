// SPDX-License-Identifier: GPL-3.0-or-later
// Two network namespaces with a virtual cable: this machine and another one, both created by the test.
#pragma once
#include <fcntl.h>
#include <sched.h>
#include <unistd.h>

#include <cstdlib>
#include <string>

namespace insula::testing {

/// `machine` (10.231.7.1) and `stranger` (10.231.7.2), each with its own loopback interface and its multicast route
/// over the cable. They are removed with this object, which must be destroyed by the thread that created it.
class NetworkRooms {
 public:
  NetworkRooms() : home_(::open("/proc/thread-self/ns/net", O_RDONLY | O_CLOEXEC)) {
    const std::string m = machine(), s = stranger(), on_m = "ip -n " + m + " ", on_s = "ip -n " + s + " ";
    ready_ = ::geteuid() == 0 && run("ip netns add " + m) && run("ip netns add " + s) &&
             run("ip link add cable0 netns " + m + " type veth peer name cable0 netns " + s) &&
             run(on_m + "addr add 10.231.7.1/24 dev cable0") && run(on_s + "addr add 10.231.7.2/24 dev cable0");
    for (const std::string& on : {on_m, on_s})
      ready_ = ready_ && run(on + "link set lo up") && run(on + "link set cable0 up") &&
               run(on + "route add 224.0.0.0/4 dev cable0");
    // A sender with this machine's address as source is let through as far as possible.
    for (const char* setting : {"all.accept_local=1", "all.rp_filter=0", "cable0.rp_filter=0"})
      ready_ = ready_ && run("ip netns exec " + m + " sysctl -qw net.ipv4.conf." + setting);
  }
  ~NetworkRooms() {
    leave();
    run("ip netns del " + machine());
    run("ip netns del " + stranger());
    if (home_ >= 0) ::close(home_);
  }
  NetworkRooms(const NetworkRooms&) = delete;
  NetworkRooms& operator=(const NetworkRooms&) = delete;

  bool ready() const { return ready_; }
  static constexpr const char *machine_address = "10.231.7.1", *stranger_address = "10.231.7.2";

  /// From now on, sockets and processes of the calling thread belong to that namespace.
  bool enter_machine() const { return enter(machine()); }
  bool enter_stranger() const { return enter(stranger()); }
  void leave() const { ::setns(home_, CLONE_NEWNET); }

 private:
  static bool run(const std::string& command) { return std::system((command + " > /dev/null 2>&1").c_str()) == 0; }
  static std::string name(const char* who) { return "insula_" + std::string(who) + "_" + std::to_string(::getpid()); }
  static std::string machine() { return name("machine"); }
  static std::string stranger() { return name("stranger"); }
  static bool enter(const std::string& which) {
    const int fd = ::open(("/run/netns/" + which).c_str(), O_RDONLY | O_CLOEXEC);
    const bool ok = fd >= 0 && ::setns(fd, CLONE_NEWNET) == 0;
    if (fd >= 0) ::close(fd);
    return ok;
  }

  int home_;
  bool ready_ = false;
};

}  // namespace insula::testing
