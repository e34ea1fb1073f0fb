// SPDX-License-Identifier: GPL-2.0-or-later
// The journal of a program that runs, as bytes: records with checksums, appended one after the other. What a
// power cut leaves at its end is known by its checksum and counts for nothing.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "base/geometry/pose.hh"
#include "base/result.hh"

namespace mw::journal {

/// A file as it was, so that another one is not taken for it.
struct FileMark {
    std::uint64_t bytes = 0;
    std::uint64_t sum = 0;

    bool operator==(const FileMark &) const = default;
};
FileMark mark_of(std::string_view content);

/// What a program began with.
struct Start {
    std::uint64_t id = 0;  ///< another one for each run
    std::string program;   ///< path
    FileMark file;
    std::string state;  ///< task's own bytes: modes, parameters, tools, what was on
    bool operator==(const Start &) const = default;
};

/// How far it has come.
struct Progress {
    std::uint64_t block = 0;  ///< the first one that is not done, counted from 1
    std::int32_t line = 0;
    std::uint64_t calls = 0;  ///< checksum of all that the program has asked for before that block
    geometry::Pose position;  ///< of the machine [machine units]
    std::int32_t tool = 0;    ///< in the spindle
    std::uint64_t tools = 0;  ///< checksum of the tool table
};

/// From a block on the state depends on what nobody can calculate again.
struct Doubt {
    std::uint64_t block = 0;
    std::int32_t line = 0;
    std::string what;
};

/// What a journal says of a run.
struct Run {
    Start start;
    std::optional<Progress> progress;
    std::optional<Doubt> doubt;  ///< the first one
    bool hasEnded = false;       ///< in order: nothing is to be gone on with
};

/// The beginning of a journal; records follow.
std::string begin_bytes(const Start &start);
/// What the checksums of its records begin with: those of another run count for nothing behind it.
std::uint64_t key_of(const Start &start);
std::string record(std::uint64_t key, const Progress &progress);
std::string record(std::uint64_t key, const Doubt &doubt);
std::string end_record(std::uint64_t key);

/// Reads as far as records are whole. An error: these bytes are no journal, or its beginning is damaged.
Result<Run> read_run(std::string_view bytes);

}  // namespace mw::journal
