// SPDX-License-Identifier: GPL-3.0-or-later
// Channels: the numbers that components publish each step. All of them lie in one block of memory.
#include <fmt/ranges.h>

#include "python/src/bind.h"

namespace insula::python {
namespace {

struct ChannelInfo {
  std::string id, doc, quantity, unit;
  std::size_t offset = 0;
  int size = 1;
  std::optional<double> low, high;
};

std::vector<ChannelInfo> infos(const Run& run) {
  std::vector<ChannelInfo> out;
  for (const ChannelEntry& e : run.simulation().channels().entries()) {
    const ChannelBase& c = *e.channel;
    out.push_back({e.id, std::string(c.spec().doc), std::string(c.quantity().name), std::string(c.quantity().si),
                   e.offset, e.size(), c.min(), c.max()});
  }
  return out;
}

/// The channels of a simulation that it keeps alive.
struct ChannelsOf {
  nb::object owner;

  const Simulation& simulation() const { return nb::cast<Run&>(owner).simulation(); }
  const ChannelEntry& at(const std::string& id) const {
    const ChannelEntry* e = simulation().channels().find(id);
    if (e) return *e;
    const std::string near = did_you_mean(nearest_name(id, simulation().channels().ids()));
    throw nb::key_error(("no channel \"" + id + "\"" + near).c_str());
  }
  const double* numbers(const ChannelEntry& e) const { return simulation().report().channels.data() + e.offset; }
};

nb::object value_of(const ChannelsOf& c, const std::string& id) {
  const ChannelEntry& e = c.at(id);
  if (e.size() == 1) return nb::float_(*c.numbers(e));
  return nb::cast(view(c.numbers(e), {std::size_t(e.size())}, c.owner));
}

void bind_channel_info(nb::module_& m) {
  nb::class_<ChannelInfo>(m, "ChannelInfo", "What a channel is.")
      .def_ro("id", &ChannelInfo::id, "\"component.channel\", or \"component.group.channel\".")
      .def_ro("doc", &ChannelInfo::doc, "Its meaning in one line.")
      .def_ro("quantity", &ChannelInfo::quantity, "Its quantity.")
      .def_ro("unit", &ChannelInfo::unit, "SI unit of its values.")
      .def_ro("offset", &ChannelInfo::offset, "Index of its first number among Channels.values.")
      .def_ro("size", &ChannelInfo::size, "1, or 3 for a vector.")
      .def_ro("low", &ChannelInfo::low, "Lower end of its expected range; None: open.")
      .def_ro("high", &ChannelInfo::high, "Upper end of its expected range; None: open.")
      .def("__repr__", [](const ChannelInfo& c) { return "<ChannelInfo " + c.id + " " + c.unit + ">"; });
}

}  // namespace

void bind_channels(nb::module_& m, RunClass& run) {
  bind_channel_info(m);
  nb::class_<ChannelsOf>(m, "Channels", "The numbers that the components of a scene publish in each step, by name.")
      .def("__len__", [](const ChannelsOf& c) { return c.simulation().channels().entries().size(); })
      .def("__contains__",
           [](const ChannelsOf& c, const std::string& id) { return c.simulation().channels().find(id) != nullptr; })
      .def("__iter__", [](const ChannelsOf& c) { return nb::iter(nb::cast(c.simulation().channels().ids())); })
      .def(
          "keys", [](const ChannelsOf& c) { return c.simulation().channels().ids(); }, "Ids of all channels.")
      .def("__getitem__", &value_of, "id"_a, nb::sig("def __getitem__(self, id: str) -> typing.Any"),
           "The value of a channel: a number, or for a vector a view of three. SI; NaN: not known now. Raises KeyError "
           "with the nearest name.")
      .def(
          "view",
          [](const ChannelsOf& c, const std::string& id) {
            const ChannelEntry& e = c.at(id);
            return view(c.numbers(e), {std::size_t(e.size())}, c.owner);
          },
          "id"_a, as_array, "View of a channel's numbers, which follows the steps.")
      .def_prop_ro(
          "values",
          [](const ChannelsOf& c) {
            const std::vector<double>& v = c.simulation().report().channels;
            return view(v.data(), {v.size()}, c.owner);
          },
          as_array,
          "View of all numbers. Its memory stays the same for the life of the simulation, and steps write into it.")
      .def_prop_ro(
          "infos", [](const ChannelsOf& c) { return infos(nb::cast<Run&>(c.owner)); },
          "What each channel is, in the order of the numbers.")
      .def("__repr__", [](const ChannelsOf& c) {
        return fmt::format("<Channels: {}>", fmt::join(c.simulation().channels().ids(), ", "));
      });
  run.def_prop_ro(
      "channels", [](nb::handle self) { return ChannelsOf{nb::borrow(self)}; }, "The channels of the scene.");
}

}  // namespace insula::python
