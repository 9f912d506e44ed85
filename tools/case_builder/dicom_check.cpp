// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/dicom_check.h"

#include <algorithm>

#include "core/model/formats/dicom_mark.h"
#include "core/model/formats/file_bytes.h"

namespace insula::case_builder {
namespace {

constexpr std::uint32_t undefined = 0xFFFFFFFF;
constexpr std::uint32_t item = 0xFFFEE000, end_of_item = 0xFFFEE00D, end_of_sequence = 0xFFFEE0DD, picture = 0x7FE00010,
                        syntax = 0x00020010;

class Walk {
 public:
  Walk(const std::filesystem::path& file, std::string_view bytes) : in_(file, bytes) { in_.seek(132); }

  /// The whole file.
  void file() {
    std::string transfer;
    bool seen = false;
    while (in_.left() > 0) {
      const bool meta = next_group() == 2;
      if (!meta && !chosen_) choose(transfer);
      if (skipped_) return;
      const Element e = element(meta || explicit_);
      seen = seen || e.tag == picture;
      if (e.length == undefined) sequence();
      else if (const std::string_view value = in_.bytes(e.length, "an element"); e.tag == syntax)
        transfer = std::string(value.substr(0, value.find('\0')));
    }
    if (!seen) in_.fail("ends early: there is no picture in it");
  }

 private:
  struct Element {
    std::uint32_t tag = 0, length = 0;
  };
  std::uint16_t next_group() {
    const std::size_t at = in_.offset();
    const auto group = in_.binary<std::uint16_t>(!machine_is_little_endian, "an element");
    in_.seek(at);
    return group;
  }
  void choose(const std::string& transfer) {
    chosen_ = true;
    explicit_ = transfer != "1.2.840.10008.1.2";
    skipped_ = transfer == "1.2.840.10008.1.2.2" ||
               transfer == "1.2.840.10008.1.2.1.99";  // big endian, deflated: rare, left to the library
  }
  Element element(bool with_kind) {
    constexpr bool swap = !machine_is_little_endian;
    Element e;
    e.tag = std::uint32_t(in_.binary<std::uint16_t>(swap, "an element")) << 16;
    e.tag |= in_.binary<std::uint16_t>(swap, "an element");
    if (!with_kind || e.tag >> 16 == 0xFFFE) {
      e.length = in_.binary<std::uint32_t>(swap, "an element");
      return e;
    }
    static constexpr std::string_view long_kinds[] = {"OB", "OD", "OF", "OL", "OV", "OW", "SQ",
                                                      "SV", "UC", "UN", "UR", "UT", "UV"};
    const std::string_view kind = in_.bytes(2, "an element");
    if (std::find(std::begin(long_kinds), std::end(long_kinds), kind) == std::end(long_kinds)) {
      e.length = in_.binary<std::uint16_t>(swap, "an element");
    } else {
      in_.bytes(2, "an element");
      e.length = in_.binary<std::uint32_t>(swap, "an element");
    }
    return e;
  }
  /// Items up to the end of a sequence of undefined length; those of a compressed picture are the same.
  void sequence() {
    if (++depth_ > 64) in_.fail("is nested too deeply");
    for (Element e = element(explicit_); e.tag != end_of_sequence; e = element(explicit_)) {
      if (e.tag != item) in_.fail("has a malformed sequence");
      if (e.length != undefined) {
        in_.bytes(e.length, "an item");
        continue;
      }
      for (Element within = element(explicit_); within.tag != end_of_item; within = element(explicit_)) {
        if (within.length == undefined) sequence();
        else in_.bytes(within.length, "an element");
      }
    }
    --depth_;
  }

  ByteCursor in_;
  bool chosen_ = false, explicit_ = true, skipped_ = false;
  int depth_ = 0;
};

}  // namespace

void check_dicom(const std::filesystem::path& file) {
  const std::string bytes = read_file_bytes(file);
  if (is_dicom_file(bytes)) Walk(file, bytes).file();
}

}  // namespace insula::case_builder
