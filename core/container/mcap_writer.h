// SPDX-License-Identifier: GPL-3.0-or-later
// Writes an MCAP file: time-stamped messages on channels, in compressed chunks with an index, and attachments.
//
//   McapWriter file("session.mcap", "insula", "insula 0.1.0");
//   const auto schema = file.add_schema("sim_event_t", "lcm", text);
//   const auto events = file.add_channel("SIM_EVENT", schema, "lcm");
//   file.write(events, time_ns, bytes);
//   file.close();
//
// Chunks are appended whole. A program that dies leaves a file without an index, whose chunks the reader finds. The
// messages of the open chunks are lost then. Schemas and channels are written in front of the chunks that use them.
//
// Channels of one lane share chunks. A reader that wants one lane unpacks no other.
#pragma once
#include <cstdio>
#include <filesystem>
#include <memory>

#include "core/container/mcap_format.h"

struct ZSTD_CCtx_s;

namespace insula {

class McapWriter {
 public:
  struct Options {
    std::size_t chunk_bytes = 1u << 20;  ///< a chunk ends when it has this many before compression
    int level = 3;                       ///< of zstd
  };

  /// Creates or replaces the file. Like all functions that write, throws InputError with the system's reason when it
  /// cannot, for example because the disk is full. The file has no further use then.
  McapWriter(const std::filesystem::path& file, const std::string& profile, const std::string& library);
  McapWriter(const std::filesystem::path& file, const std::string& profile, const std::string& library,
             Options options);
  /// Closes the file; a failure is ignored. Call close() to hear of it.
  ~McapWriter();
  McapWriter(const McapWriter&) = delete;
  McapWriter& operator=(const McapWriter&) = delete;

  /// Returns its number, from 1. At most 65,535 of them; the same for channels.
  std::uint16_t add_schema(const std::string& name, const std::string& encoding, const std::string& data);
  /// schema: 0 for none. lane: from 0, below max_lanes.
  std::uint16_t add_channel(const std::string& topic, std::uint16_t schema, const std::string& encoding,
                            const mcap::Text& metadata = {}, std::size_t lane = 0);
  static constexpr std::size_t max_lanes = 8;
  /// A message at that time, ns. Times should not decrease. It becomes part of the open chunk of its channel's lane.
  void write(std::uint16_t channel, std::uint64_t time_ns, mcap::Bytes data);
  void attach(const std::string& name, const std::string& media_type, std::uint64_t time_ns, mcap::Bytes data);
  void describe(const std::string& name, const mcap::Text& metadata);
  /// Ends the open chunks and gives them to the operating system, which keeps them when this program dies.
  void flush();
  /// Ends the open chunk of one lane.
  void flush(std::size_t lane);
  /// Ends the file with its index.
  void close();

  std::uint64_t bytes() const { return at_; }  ///< written to the file
  std::uint64_t messages() const { return messages_; }

 private:
  struct ChunkPlace {
    std::uint64_t first_ns = 0, last_ns = 0, start = 0, length = 0, index_length = 0, packed = 0, whole = 0;
    std::map<std::uint16_t, std::uint64_t> index_at;
  };
  struct AttachmentPlace {
    std::uint64_t start = 0, length = 0, time_ns = 0, size = 0;
    std::string name, media_type;
  };
  struct MetadataPlace {
    std::uint64_t start = 0, length = 0;
    std::string name;
  };
  struct Channel {
    std::size_t lane = 0;
    std::uint64_t messages = 0;
    mcap::Buffer index;  ///< time and offset of its messages in the open chunk
  };

  struct Lane {
    ChunkPlace open;
    mcap::Buffer chunk;
  };

  void put(mcap::Bytes bytes);
  void put_record(mcap::Op op, mcap::Bytes content);
  void put_summary();

  std::filesystem::path file_;
  Options options_;
  std::FILE* out_ = nullptr;
  ZSTD_CCtx_s* zstd_ = nullptr;
  std::uint64_t at_ = 0, messages_ = 0, first_ns_ = 0, last_ns_ = 0;
  std::vector<Lane> lanes_;
  mcap::Buffer packed_, scratch_;
  mcap::Buffer schemas_, channels_;  ///< their records, for the summary
  std::uint16_t schema_count_ = 0;
  std::vector<Channel> channel_;  ///< by number less 1
  std::vector<ChunkPlace> chunks_;
  std::vector<AttachmentPlace> attachments_;
  std::vector<MetadataPlace> described_;
};

}  // namespace insula
