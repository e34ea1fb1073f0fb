// SPDX-License-Identifier: GPL-2.0-or-later
// Journals: any bytes as a file, after a valid beginning, and as the state in a record with a valid checksum.
// A state that was read and written must be read unchanged.
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <string>
#include <string_view>

#include "gcode/canon/machine_frame.hh"
#include "gcode/interpreter/interpreter.hh"
#include "machine/journal/records.hh"
#include "machine/task/run/start_record.hh"
#include "tests/fuzz/null_machine.hh"

namespace {

using namespace mw;

void check(bool isRight) {
    if (!isRight) {
        std::abort();
    }
}

void read_any(std::string_view bytes) {
    const auto run = journal::read_run(bytes);
    if (run.has_value()) {
        const auto again = journal::read_run(journal::begin_bytes(run->start));
        check(again.has_value() && again->start == run->start);
    }
}

void read_behind_a_beginning(std::string_view bytes) {
    const journal::Start start{3, "p.ngc", journal::mark_of("G0"), "state"};
    std::string file = journal::begin_bytes(start) +
                       journal::record(journal::key_of(start), journal::Progress{.block = 7, .position = {}});
    file += bytes;
    const auto run = journal::read_run(file);
    check(!run.has_value() || (run->start == start && run->progress.has_value()));
}

void read_state(std::string_view bytes) {
    const auto record = task::StartRecord::unpack(bytes);
    if (record.has_value()) {
        static_cast<void>(record->calls());
        const auto again = task::StartRecord::unpack(record->pack());
        check(again.has_value() && again->pack() == record->pack());
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    const std::string_view bytes(reinterpret_cast<const char *>(data), size);
    read_any(bytes);
    read_behind_a_beginning(bytes);
    read_state(bytes);
    return 0;
}
