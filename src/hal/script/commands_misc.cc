// SPDX-License-Identifier: GPL-2.0-or-later
// Locks, messages, files and help.
#include <fmt/format.h>

#include "base/text.hh"
#include "hal/script/commands.hh"

namespace mw::hal::script {

namespace {

struct LockWord {
    std::string_view word;
    std::uint8_t lock;
};

constexpr LockWord LOCKS[] = {{"none", LOCK_NONE}, {"tune", LOCK_TUNE}, {"all", LOCK_ALL}};

struct LockLine {
    std::uint8_t bit;
    const char *text;
};

constexpr LockLine LOCK_LINES[] = {
    {LOCK_LOAD, "  HAL_LOCK_LOAD    - loading of new components is locked\n"},
    {LOCK_CONFIG, "  HAL_LOCK_CONFIG  - link and addf is locked\n"},
    {LOCK_PARAMS, "  HAL_LOCK_PARAMS  - setting params is locked\n"},
    {LOCK_RUN, "  HAL_LOCK_RUN     - running/stopping HAL is locked\n"},
};

std::string lock_status(std::uint8_t lock) {
    std::string text = "HAL locking status:\n";
    text += fmt::format("  current lock value {} ({:02x})\n", lock, lock);
    if (lock == LOCK_NONE) {
        return text + "  HAL_LOCK_NONE - nothing is locked\n";
    }
    for (const LockLine &line : LOCK_LINES) {
        if ((lock & line.bit) != 0) {
            text += line.text;
        }
    }
    return text;
}

std::string memory_status(const MemoryStatistics &s) {
    std::string text = "HAL memory status\n";
    text += fmt::format("  used/total shared memory:   {}/{}\n", s.segment_bytes, s.capacity_bytes);
    const auto line = [&](const char *title, const RecordCount &count) {
        text += fmt::format("  {:<28}{}/{}\n", title, count.active, count.recycled);
    };
    line("active/recycled components:", s.components);
    line("active/recycled pins:", s.pins);
    line("active/recycled parameters:", s.params);
    line("active/recycled aliases:", s.aliases);
    line("active/recycled signals:", s.signals);
    line("active/recycled functions:", s.functs);
    line("active/recycled threads:", s.threads);
    return text;
}

/// Components whose process died: empty when there are none.
std::string death_status(Instance &hal) {
    std::string text;
    for (const DeathInfo &death : hal.processes().deaths()) {
        text += text.empty() ? "HAL components that died:\n" : "";
        text += fmt::format("  {} (process {}, {} s ago)\n", death.name, death.pid,
                            (hal.now_ns() - death.time_ns) / 1'000'000'000);
    }
    return text;
}

/// The lock named by word 0; without a word all locks. `none` only if it is valid here.
Result<std::uint8_t> lock_of(const Call &call, bool allowsNone) {
    if (call.words.empty()) {
        return LOCK_ALL;
    }
    for (const LockWord &lock : LOCKS) {
        if (lock.word == call.text(0) && (allowsNone || lock.lock != LOCK_NONE)) {
            return lock.lock;
        }
    }
    return fail(fmt::format("unknown lock type '{}'", call.text(0)), call.place_of(0),
                allowsNone ? "none, tune or all" : "tune or all");
}

}  // namespace

Result<> run_lock(Session &session, const Call &call) {
    const Result<std::uint8_t> lock = lock_of(call, true);
    if (!lock) {
        return std::unexpected(lock.error());
    }
    const Result<> locked = at(session.hal().set_lock(*lock), call.place);
    if (locked) {
        session.info(call.place, "Locking completed");
    }
    return locked;
}

Result<> run_unlock(Session &session, const Call &call) {
    const Result<std::uint8_t> unlocked = lock_of(call, false);
    if (!unlocked) {
        return std::unexpected(unlocked.error());
    }
    const auto left = static_cast<std::uint8_t>(session.hal().lock() & ~*unlocked);
    const Result<> unlocked_now = at(session.hal().set_lock(left), call.place);
    if (unlocked_now) {
        session.info(call.place, "Unlocking completed");
    }
    return unlocked_now;
}

Result<> run_status(Session &session, const Call &call) {
    const std::string what = call.words.empty() ? "all" : call.text(0);
    const bool all = what == "all";
    if (!all && what != "lock" && what != "mem") {
        return fail(fmt::format("unknown 'status' type '{}'", what), call.place_of(0), "lock, mem or all");
    }
    std::string text;
    if (all || what == "lock") {
        text += lock_status(session.hal().lock());
    }
    if (all || what == "mem") {
        text += memory_status(session.hal().memory().statistics());
    }
    session.output().data(all ? text + death_status(session.hal()) : text);
    return {};
}

Result<> run_source(Session &session, const Call &call) {
    return session.run_file(call.text(0));
}

Result<> run_echo(Session &session, const Call &) {
    session.options().isEchoing = true;
    session.output().data("Echo on\n");
    return {};
}

Result<> run_unecho(Session &session, const Call &) {
    session.options().isEchoing = false;
    session.output().data("Echo off\n");
    return {};
}

Result<> run_print(Session &session, const Call &call) {
    SourcePlace line = call.place;
    line.column = 0;
    const std::string where = line.str();
    const std::string text = call.words.empty() ? "" : call.words[0].raw;
    session.output().note(fmt::format("{}{}HALCMD MSG: {}", where, where.empty() ? "" : ": ", text));
    return {};
}

Result<> run_debug(Session &session, const Call &call) {
    const std::optional<std::int64_t> level = parse_int(call.text(0));
    constexpr std::int64_t HIGHEST = 5;
    if (!level || *level < 0 || *level > HIGHEST) {
        return fail(fmt::format("'{}' is not a debug level", call.text(0)), call.place_of(0), "0 to 5");
    }
    return at(session.host().set_log_level(static_cast<runtime::LogLevel>(*level)), call.place);
}

Result<> run_help(Session &session, const Call &call) {
    if (call.words.empty()) {
        session.output().data(help_overview());
        return {};
    }
    const CommandSpec *spec = find_command(call.text(0));
    if (spec == nullptr) {
        return std::unexpected(unknown_command(call.words[0]));
    }
    session.output().data(help_text(*spec));
    return {};
}

Result<> run_exit(Session &session, const Call &) {
    session.end();
    return {};
}

Result<> run_setexact(Session &, const Call &) {
    return {};
}

}  // namespace mw::hal::script
