// SPDX-License-Identifier: GPL-2.0-or-later
#include "clients/schedule/words.hh"

#include <fmt/format.h>

#include "base/text.hh"

namespace mw::schedule {
namespace {

using Lines = std::vector<std::string>;
using Answer = Result<Lines>;

std::string word(const Said &said, std::size_t place) {
    return said.words.size() > place ? said.words[place] : std::string();
}

Result<int> whole(const Said &said, std::size_t place, const char *what) {
    const auto value = parse_int(word(said, place));
    if (!value.has_value() || *value < INT32_MIN || *value > INT32_MAX) {
        return fail(fmt::format("Invalid {} '{}', not a whole number", what, printable(word(said, place))));
    }
    return static_cast<int>(*value);
}

Queue &queue_of(const Said &said) {
    return said.shared.scheduler.queue();
}

/// The program with the tag in the word at `place`.
Result<Job> job_by_tag(const Said &said, std::size_t place) {
    const auto tag = whole(said, place, "tag");
    if (!tag.has_value()) {
        return std::unexpected(tag.error());
    }
    const Job *const job = queue_of(said).by_tag(*tag);
    return job != nullptr ? Result<Job>(*job) : fail(fmt::format("no program has the tag {}", *tag));
}

Result<Job> job_by_index(const Said &said, std::size_t place) {
    const auto index = whole(said, place, "index");
    if (!index.has_value()) {
        return std::unexpected(index.error());
    }
    const Job *const job = queue_of(said).by_index(*index);
    return job != nullptr ? Result<Job>(*job)
                          : fail(fmt::format("there is no place {} in the queue", *index));
}

std::string row_of(const char *name, const Job &job) {
    return fmt::format("{} {} {} {:.6f} {:.6f} {:.6f} {} {} {:.6f} {:.6f} {}", name, job.priority, job.tag,
                       job.x, job.y, job.z, job.zone, job.file, job.feed_percent, job.spindle_percent,
                       job.tool);
}

const char *text_of(QueueMode mode) {
    switch (mode) {
    case QueueMode::STOP: return "STOP";
    case QueueMode::RUN: return "RUN";
    case QueueMode::PAUSE: return "PAUSE";
    case QueueMode::ERROR: break;
    }
    return "ERROR";
}

const char *on_off(bool on) {
    return on ? "ON" : "OFF";
}

Answer one(std::string line) {
    return Lines{std::move(line)};
}

Answer tell_queue(const Said &said) {
    const auto &jobs = queue_of(said).jobs();
    return one(fmt::format("QSTATUS {} {} {} {}", jobs.size(), jobs.empty() ? 0 : jobs.front().tag,
                           jobs.empty() ? 0 : jobs.back().tag, queue_of(said).checksum()));
}

Answer tell_all(const Said &said) {
    Lines lines;
    for (const Job &job : queue_of(said).jobs()) {
        lines.push_back(row_of("PGMBYINDEX", job));
    }
    return lines;
}

Answer tell_ini(const Said &said) {
    const ini::IniFile *const ini = said.shared.settings.ini;
    const ini::IniEntry *const entry = ini == nullptr ? nullptr : ini->find(word(said, 1), word(said, 0));
    return entry != nullptr
               ? one("INI " + entry->value)
               : fail(fmt::format("there is no [{}]{}", printable(word(said, 1)), printable(word(said, 0))));
}

using Asking = Answer (*)(const Said &);
struct Question {
    const char *name, *usage;
    Asking ask;
};

constexpr Question QUESTIONS[] = {
    {"AUTOTAGID", "",
     [](const Said &s) { return one(fmt::format("AUTOTAGID {}", queue_of(s).last_auto_tag())); }},
    {"COMM_MODE", "", [](const Said &) { return one("COMM_MODE ASCII"); }},
    {"COMM_PROT", "", [](const Said &s) { return one("COMM_PROT " + s.own.protocol); }},
    {"CONFIG", "", [](const Said &) { return one("CONFIG"); }},
    {"DEBUG", "",
     [](const Said &s) { return one(fmt::format("DEBUG {}", s.shared.view.status().settings.debug)); }},
    {"ECHO", "", [](const Said &s) { return one(fmt::format("ECHO {}", on_off(s.own.isEchoing))); }},
    {"ENABLE", "", [](const Said &s) { return one(fmt::format("ENABLE {}", on_off(s.own.isEnabled))); }},
    {"ERROR", "",
     [](const Said &s) {
         const std::string &why = s.shared.scheduler.error();
         return one("ERROR " + (why.empty() ? "OK" : why));
     }},
    {"INI", "<key> <section>", tell_ini},
    {"INIFILE", "",
     [](const Said &s) {
         const ini::IniFile *const ini = s.shared.settings.ini;
         return one("INIFILE " + (ini == nullptr ? std::string() : ini->path()));
     }},
    {"PGMALL", "", tell_all},
    {"PGMBYID", "<tag>",
     [](const Said &s) -> Answer {
         const auto job = job_by_tag(s, 0);
         return job.has_value() ? one(row_of("PGMBYID", *job)) : std::unexpected(job.error());
     }},
    {"PGMBYINDEX", "<index>",
     [](const Said &s) -> Answer {
         const auto job = job_by_index(s, 0);
         return job.has_value() ? one(row_of("PGMBYINDEX", *job)) : std::unexpected(job.error());
     }},
    {"PLAT", "", [](const Said &) { return one("PLAT Linux"); }},
    {"POLLRATE", "",
     [](const Said &s) { return one(fmt::format("POLLRATE {:.6f}", s.shared.scheduler.poll_s)); }},
    {"PRIORITYBYID", "<tag>",
     [](const Said &s) -> Answer {
         const auto job = job_by_tag(s, 0);
         return job.has_value() ? one(fmt::format("PRIORITYBYID {} {}", job->tag, job->priority))
                                : std::unexpected(job.error());
     }},
    {"PRIORITYBYINDEX", "<index>",
     [](const Said &s) -> Answer {
         const auto job = job_by_index(s, 0);
         return job.has_value() ? one(fmt::format("PRIORITYBYINDEX {} {}", word(s, 0), job->priority))
                                : std::unexpected(job.error());
     }},
    {"QMODE", "",
     [](const Said &s) { return one(fmt::format("QMODE {}", text_of(s.shared.scheduler.mode()))); }},
    {"QSTATUS", "", tell_queue},
    {"VERBOSE", "", [](const Said &s) { return one(fmt::format("VERBOSE {}", on_off(s.own.isVerbose))); }},
};

template <bool OwnState::*SETTING>
Result<> switch_own(const Said &said) {
    const auto on = rsh::on_or_off(word(said, 0));
    if (!on.has_value()) {
        return std::unexpected(on.error());
    }
    said.own.*SETTING = *on;
    return {};
}

Result<> enable(const Said &said) {
    said.own.isEnabled = !rsh::isSameWord(word(said, 0), "OFF") &&
                         rsh::isSamePassword(word(said, 0), said.shared.settings.enable_password);
    const bool is_meant = said.own.isEnabled || rsh::isSameWord(word(said, 0), "OFF");
    return is_meant ? Result<>{} : fail("the password is wrong");
}

Result<> set_comm_mode(const Said &said) {
    return rsh::isSameWord(word(said, 0), "ASCII") ? Result<>{} : rsh::no_such_value(word(said, 0), "ASCII");
}

Result<> set_protocol(const Said &said) {
    const std::string wanted = word(said, 0);
    if (wanted != "1" && wanted != "1.0" && wanted != "1.1") {
        return rsh::no_such_value(wanted, "1, 1.0, 1.1");
    }
    said.own.protocol = wanted;
    return {};
}

Result<> set_queue_mode(const Said &said) {
    enum class Wanted : std::uint8_t { STOP, RUN, PAUSE, RESUME };
    const auto wanted = rsh::one_of<Wanted>(
        word(said, 0),
        {{"STOP", Wanted::STOP}, {"RUN", Wanted::RUN}, {"PAUSE", Wanted::PAUSE}, {"RESUME", Wanted::RESUME}});
    if (!wanted.has_value()) {
        return std::unexpected(wanted.error());
    }
    Scheduler &scheduler = said.shared.scheduler;
    switch (*wanted) {
    case Wanted::STOP: return scheduler.stop();
    case Wanted::RUN: return scheduler.run(said.shared.view.status());
    case Wanted::PAUSE: return scheduler.pause();
    case Wanted::RESUME: break;
    }
    return scheduler.resume();
}

Result<> add_program(const Said &said) {
    constexpr std::size_t WORDS = 10;
    if (said.words.size() != WORDS) {
        return fail(fmt::format("PGMADD needs {} words, here are {}", WORDS, said.words.size()));
    }
    const auto priority = whole(said, 0, "priority"), tag = whole(said, 1, "tag"),
               zone = whole(said, 5, "zone"), tool = whole(said, 9, "tool");
    for (const auto *number : {&priority, &tag, &zone, &tool}) {
        if (!number->has_value()) {
            return std::unexpected(number->error());
        }
    }
    const auto x = rsh::number(word(said, 2), "offset"), y = rsh::number(word(said, 3), "offset"),
               z = rsh::number(word(said, 4), "offset"), feed = rsh::number(word(said, 7), "feed override"),
               spindle = rsh::number(word(said, 8), "spindle override");
    for (const auto *number : {&x, &y, &z, &feed, &spindle}) {
        if (!number->has_value()) {
            return std::unexpected(number->error());
        }
    }
    return queue_of(said).add({*priority, *tag, *x, *y, *z, *zone, word(said, 6), *feed, *spindle, *tool});
}

Result<> set_priority_of(const Said &said, const Result<Job> &job) {
    const auto priority = whole(said, 1, "priority");
    if (!job.has_value() || !priority.has_value()) {
        return std::unexpected(job.has_value() ? priority.error() : job.error());
    }
    queue_of(said).set_priority(job->tag, *priority);
    return {};
}

Result<> remove(const Said &said, const Result<Job> &job) {
    return job.has_value() ? said.shared.scheduler.remove(job->tag) : std::unexpected(job.error());
}

Result<> set_poll_rate(const Said &said) {
    constexpr double SHORTEST_S = 0.01, LONGEST_S = 3600;
    const auto seconds = rsh::number(word(said, 0), "rate");
    if (!seconds.has_value() || !(*seconds >= SHORTEST_S && *seconds <= LONGEST_S)) {
        return fail(fmt::format("Invalid rate '{}', valid: {} to {} s", printable(word(said, 0)), SHORTEST_S,
                                LONGEST_S));
    }
    said.shared.scheduler.poll_s = *seconds;
    return {};
}

enum class Needs : std::uint8_t { HELLO, ENABLE };
using Ordering = Result<> (*)(const Said &);
struct Order {
    const char *name;
    Needs needs;
    const char *usage;
    Ordering carry_out;
};

constexpr Order ORDERS[] = {
    {"AUTOTAGID", Needs::ENABLE, "<last tag>",
     [](const Said &s) -> Result<> {
         const auto tag = whole(s, 0, "tag");
         return tag.has_value() ? queue_of(s).set_last_auto_tag(*tag) : std::unexpected(tag.error());
     }},
    {"COMM_MODE", Needs::HELLO, "<Ascii>", set_comm_mode},
    {"COMM_PROT", Needs::HELLO, "<version>", set_protocol},
    {"DELETEBYID", Needs::ENABLE, "<tag>", [](const Said &s) { return remove(s, job_by_tag(s, 0)); }},
    {"DELETEBYINDEX", Needs::ENABLE, "<index>", [](const Said &s) { return remove(s, job_by_index(s, 0)); }},
    {"ECHO", Needs::HELLO, "<On | Off>", switch_own<&OwnState::isEchoing>},
    {"ENABLE", Needs::HELLO, "<password | Off>", enable},
    {"PGMADD", Needs::ENABLE,
     "<priority> <tag> <x> <y> <z> <zone> <file> <feed override> <spindle override> <tool>", add_program},
    {"POLLRATE", Needs::ENABLE, "<seconds>", set_poll_rate},
    {"PRIORITYBYID", Needs::ENABLE, "<tag> <priority>",
     [](const Said &s) { return set_priority_of(s, job_by_tag(s, 0)); }},
    {"PRIORITYBYINDEX", Needs::ENABLE, "<index> <priority>",
     [](const Said &s) { return set_priority_of(s, job_by_index(s, 0)); }},
    {"QMODE", Needs::ENABLE, "<Stop | Run | Pause | Resume>", set_queue_mode},
    {"VERBOSE", Needs::HELLO, "<On | Off>", switch_own<&OwnState::isVerbose>},
};

template <class Row>
void list(const Row &rows, Lines &lines) {
    for (const auto &row : rows) {
        lines.push_back(fmt::format("    {} {}", row.name, row.usage));
    }
}

}  // namespace

Answer answer_to(const std::string &name, const Said &said) {
    for (const Question &question : QUESTIONS) {
        if (question.name == name) {
            return question.ask(said);
        }
    }
    return fail(fmt::format("Unknown question '{}'", printable(name)));
}

Result<> carry_out_order(const std::string &name, const Said &said) {
    for (const Order &order : ORDERS) {
        if (order.name == name && order.needs == Needs::ENABLE && !said.own.isEnabled) {
            return fail(fmt::format("Connection must be 'ENABLED' for SET {}", name));
        }
        if (order.name == name) {
            return order.carry_out(said);
        }
    }
    return fail(fmt::format("Unknown order '{}'", printable(name)));
}

Lines help(const std::string &about) {
    Lines lines;
    if (about == "GET") {
        lines = {"Usage: Get <question>", "  Questions:"};
        list(QUESTIONS, lines);
    } else if (about == "SET") {
        lines = {"Usage: Set <order>", "  Needs Hello, most need 'Set enable <password>'. Orders:"};
        list(ORDERS, lines);
    } else if (about.empty()) {
        lines = {"Available commands:", "  Hello <password> <client name> <protocol version>",
                 "  Get <question>",    "  Set <order>",
                 "  Shutdown",          "  Quit",
                 "  Help [Get | Set]"};
    } else {
        lines = {about + " is not a valid command."};
    }
    return lines;
}

}  // namespace mw::schedule
