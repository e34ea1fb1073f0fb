// SPDX-License-Identifier: GPL-2.0-or-later
// The journal of a running program, as bytes: records with checksums, appended one after the other. After a
// power cut the last record may be incomplete; its checksum detects this and it is ignored.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/geometry/pose.hh"
#include "base/result.hh"

namespace mw::journal {

/// Identity of a file, to detect a replaced one.
struct FileMark {
    std::uint64_t bytes = 0;
    std::uint64_t sum = 0;

    bool operator==(const FileMark &) const = default;
};
FileMark mark_of(std::string_view content);

/// State at the start of a program.
struct Start {
    std::uint64_t id = 0;  ///< different for each run
    std::string program;   ///< path
    FileMark file;
    std::string state;  ///< state of task as bytes: modes, parameters, tools, active outputs
    bool operator==(const Start &) const = default;
};

/// Progress of a run.
struct Progress {
    std::uint64_t block = 0;  ///< number of the first block that is not done, from 1
    std::int32_t line = 0;
    std::uint64_t calls = 0;  ///< checksum of all canon calls before that block
    geometry::Pose position;  ///< position of the machine [machine units]
    std::int32_t tool = 0;    ///< tool in the spindle
    std::uint64_t tools = 0;  ///< checksum of the tool table
};

/// The state depends on values that cannot be calculated again, beginning with this block.
struct Doubt {
    std::uint64_t block = 0;
    std::int32_t line = 0;
    std::string what;
};

/// Content of a journal.
struct Run {
    Start start;
    std::optional<Progress> progress;
    std::optional<Doubt> doubt;  ///< the first one
    bool ended = false;          ///< the run ended normally, so there is nothing to continue
};

/// The start of a journal; records follow.
std::string begin_bytes(const Start &start);
/// Initial value of the checksums of its records, so that remaining records of another run are not valid.
std::uint64_t key_of(const Start &start);
std::string record(std::uint64_t key, const Progress &progress);
std::string record(std::uint64_t key, const Doubt &doubt);
std::string end_record(std::uint64_t key);

/// Reads the complete records. It is an error if the bytes are not a journal, or its start is damaged.
Result<Run> read_run(std::string_view bytes);

}  // namespace mw::journal
