// SPDX-License-Identifier: GPL-2.0-or-later
#include "config/ini_reader.hh"

#include <cmath>

#include "base/text.hh"
#include "config/ini_value.hh"

namespace mw::config {
namespace {

std::string label(std::string_view section, std::string_view key) {
    return '[' + std::string(section) + ']' + std::string(key);
}

std::string describe(const RealRange &range) {
    const bool hasLowest = range.lowest != -std::numeric_limits<double>::infinity();
    const bool hasHighest = range.highest != std::numeric_limits<double>::infinity();
    std::string text = "a number";
    if (hasLowest) {
        text += (range.isLowestExcluded ? " above " : " of at least ") + to_text(range.lowest);
    }
    if (hasHighest) {
        text += (hasLowest ? " and at most " : " of at most ") + to_text(range.highest);
    }
    return text;
}

std::string describe(std::int64_t lowest, std::int64_t highest) {
    return "a whole number from " + std::to_string(lowest) + " to " + std::to_string(highest);
}

}  // namespace

void IniReader::know(std::string_view section, std::string_view key) {
    known_[std::string(section)].insert(std::string(key));
}

void IniReader::know_all(std::string_view section, std::initializer_list<std::string_view> keys) {
    for (const std::string_view key : keys) {
        know(section, key);
    }
}

void IniReader::know_if_ours(std::string_view section, std::string_view key) {
    const auto found = known_.find(section);
    if (found != known_.end()) {
        found->second.insert(std::string(key));
    }
}

void IniReader::leave_open(std::string_view section) {
    open_.insert(std::string(section));
}

const IniEntry *IniReader::scalar(std::string_view section, std::string_view key) {
    know(section, key);
    const IniEntry *first = file_.find(section, key);
    const IniEntry *second = file_.find(section, key, 2);
    if (second != nullptr && warned_twice_.insert(label(section, key)).second) {
        sink_.warning(label(section, key) + " is given twice; the first one, '" + first->value + "' in " +
                          first->place.str() + ", is used",
                      second->place);
    }
    return first;
}

void IniReader::missing(std::string_view section, std::string_view key, const std::string &expected) {
    const bool hasSection = file_.hasSection(section);
    if (!hasSection && !missing_sections_.insert(std::string(section)).second) {
        return;  // one message for the whole section
    }
    const std::string near = nearest_name(key, file_.keys(section));
    sink_.error(hasSection ? label(section, key) + " is missing"
                           : "section [" + std::string(section) + "] is missing",
                file_.place_of_section(section),
                "expected " + label(section, key) + " = " + expected +
                    (near.empty() ? "" : "; is '" + near + "' a misspelling?"));
}

std::optional<double> IniReader::number(const IniEntry &entry, const RealRange &range) {
    const std::vector<std::string> words = split_words(entry.value);
    const auto value = words.empty() ? std::nullopt : parse_double(words[0]);
    const bool isCommentAfter = words.size() > 1 && (words[1][0] == '#' || words[1][0] == ';');
    if (!value.has_value() || (words.size() > 1 && !isCommentAfter)) {
        sink_.error(label(entry.section, entry.key) + " = '" + entry.value + "' is not a number", entry.place,
                    "expected " + describe(range) + ", with a decimal point");
        return std::nullopt;
    }
    const bool isTooLow = *value < range.lowest || (range.isLowestExcluded && *value == range.lowest);
    if (isTooLow || *value > range.highest) {
        sink_.error(label(entry.section, entry.key) + " = " + entry.value + " is out of range", entry.place,
                    "expected " + describe(range));
        return std::nullopt;
    }
    return value;
}

std::optional<std::int64_t> IniReader::whole(const IniEntry &entry, std::int64_t lowest,
                                             std::int64_t highest) {
    const std::vector<std::string> words = split_words(entry.value);
    auto value = words.empty() ? std::nullopt : parse_int(words[0]);
    if (!value.has_value() && !words.empty()) {
        // "1.0" is a whole number too.
        const auto real = parse_double(words[0]);
        // Beyond 2^53 a double no longer says which whole number is meant.
        constexpr double LARGEST = 9007199254740992.0;
        if (real.has_value() && std::fabs(*real) <= LARGEST && *real == std::floor(*real)) {
            value = static_cast<std::int64_t>(*real);
        }
    }
    const bool isCommentAfter = words.size() > 1 && (words[1][0] == '#' || words[1][0] == ';');
    if (!value.has_value() || (words.size() > 1 && !isCommentAfter)) {
        sink_.error(label(entry.section, entry.key) + " = '" + entry.value + "' is not a whole number",
                    entry.place, "expected " + describe(lowest, highest));
        return std::nullopt;
    }
    if (*value < lowest || *value > highest) {
        sink_.error(label(entry.section, entry.key) + " = " + entry.value + " is out of range", entry.place,
                    "expected " + describe(lowest, highest));
        return std::nullopt;
    }
    return value;
}

double IniReader::real(std::string_view section, std::string_view key, double preset, RealRange range) {
    const IniEntry *entry = scalar(section, key);
    return entry == nullptr ? preset : number(*entry, range).value_or(preset);
}

double IniReader::required_real(std::string_view section, std::string_view key, RealRange range) {
    const IniEntry *entry = scalar(section, key);
    if (entry == nullptr) {
        missing(section, key, describe(range));
        return 0.0;
    }
    return number(*entry, range).value_or(0.0);
}

std::int64_t IniReader::integer(std::string_view section, std::string_view key, std::int64_t preset,
                                std::int64_t lowest, std::int64_t highest) {
    const IniEntry *entry = scalar(section, key);
    return entry == nullptr ? preset : whole(*entry, lowest, highest).value_or(preset);
}

std::int64_t IniReader::required_integer(std::string_view section, std::string_view key, std::int64_t lowest,
                                         std::int64_t highest) {
    const IniEntry *entry = scalar(section, key);
    if (entry == nullptr) {
        missing(section, key, describe(lowest, highest));
        return lowest;
    }
    return whole(*entry, lowest, highest).value_or(lowest);
}

bool IniReader::boolean(std::string_view section, std::string_view key, bool preset) {
    const IniEntry *entry = scalar(section, key);
    if (entry == nullptr) {
        return preset;
    }
    const std::vector<std::string> words = split_words(entry->value);
    if (const auto truth = ini_bool(words.empty() ? "" : words[0])) {
        return *truth;
    }
    sink_.error(label(section, key) + " = '" + entry->value + "' is neither true nor false", entry->place,
                "expected YES, TRUE or 1, or NO, FALSE or 0");
    return preset;
}

std::string IniReader::text(std::string_view section, std::string_view key, std::string_view preset) {
    const IniEntry *entry = scalar(section, key);
    return entry == nullptr ? std::string(preset) : entry->value;
}

std::string IniReader::required_text(std::string_view section, std::string_view key) {
    const IniEntry *entry = scalar(section, key);
    if (entry == nullptr || entry->value.empty()) {
        missing(section, key, "a text");
        return {};
    }
    return entry->value;
}

std::string IniReader::choice(std::string_view section, std::string_view key, std::string_view preset,
                              const std::vector<std::string> &choices) {
    const IniEntry *entry = scalar(section, key);
    if (entry == nullptr) {
        return std::string(preset);
    }
    std::string all;
    for (const std::string &one : choices) {
        if (equals_ignoring_case(one, entry->value)) {
            return one;
        }
        all += (all.empty() ? "" : ", ") + one;
    }
    sink_.error(label(section, key) + " = '" + entry->value + "' is not known", entry->place,
                "expected one of " + all);
    return std::string(preset);
}

std::vector<const IniEntry *> IniReader::list(std::string_view section, std::string_view key) {
    know(section, key);
    return file_.find_all(section, key);
}

void IniReader::know_without_effect(std::string_view section, std::string_view key, std::string_view why) {
    know(section, key);
    without_effect_.insert_or_assign(label(section, key), std::string(why));
}

/// Sections whose name is a misspelling of one that the system reads.
void IniReader::report_sections(diag::Severity severity) {
    std::vector<std::string> names;
    for (const auto &[name, keys] : known_) {
        names.push_back(name);
    }
    for (const std::string &section : file_.sections()) {
        const bool isMeant =
            known_.count(section) > 0 || open_.count(section) > 0 || used_sections_.count(section) > 0;
        const std::string near = isMeant ? "" : nearest_name(section, names);
        if (!near.empty() && used_sections_.insert(section).second) {
            sink_.report({severity,
                          {"unknown section [" + section + "]; it has no effect",
                           file_.place_of_section(section), "did you mean [" + near + "]?"}});
        }
    }
}

void IniReader::report_unknown(bool isStrict) {
    const diag::Severity severity = isStrict ? diag::Severity::ERROR : diag::Severity::WARNING;
    for (const IniEntry &entry : file_.entries()) {
        SourcePlace place = entry.place;
        place.column = 1;
        const auto why = without_effect_.find(label(entry.section, entry.key));
        if (why != without_effect_.end()) {
            sink_.report({severity, {why->first + " has no effect: " + why->second, place, {}}});
            without_effect_.erase(why);  // once
        }
        const auto section = known_.find(entry.section);
        if (section == known_.end() || open_.count(entry.section) > 0 ||
            section->second.count(entry.key) > 0) {
            continue;
        }
        if (!reported_.insert(label(entry.section, entry.key)).second) {
            continue;
        }
        const std::vector<std::string> names(section->second.begin(), section->second.end());
        const std::string near = nearest_name(entry.key, names);
        sink_.report({severity,
                      {"unknown key " + label(entry.section, entry.key) + "; it has no effect", place,
                       near.empty() ? "" : "did you mean " + near + "?"}});
    }
    report_sections(severity);
}

}  // namespace mw::config
