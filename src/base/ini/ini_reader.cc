// SPDX-License-Identifier: GPL-2.0-or-later
#include "base/ini/ini_reader.hh"

#include <algorithm>
#include <cmath>

#include "base/ini/ini_value.hh"
#include "base/text.hh"

namespace mw::ini {
namespace {

std::string label(std::string_view section, std::string_view key) {
    return '[' + std::string(section) + ']' + std::string(key);
}

std::string describe_number(const IniKey &key) {
    const bool has_lowest = key.lowest != -INI_UNBOUNDED;
    const bool has_highest = key.highest != INI_UNBOUNDED;
    std::string text = "a number";
    if (has_lowest) {
        text += " of at least " + to_text(key.lowest);
    }
    if (has_highest) {
        text += (has_lowest ? " and at most " : " of at most ") + to_text(key.highest);
    }
    return text;
}

std::string describe_whole(const IniKey &key) {
    return "a whole number from " + to_text(key.lowest) + " to " + to_text(key.highest);
}

std::string_view name_of(const IniKey &key, std::string_view section) {
    return section.empty() ? key.section : section;
}

/// A value with " #" or " ;" in it: probably meant as a comment.
bool hasCommentAfter(std::string_view value) {
    for (std::size_t at = 1; at < value.size(); ++at) {
        const bool is_mark = value[at] == '#' || value[at] == ';';
        if (is_mark && (value[at - 1] == ' ' || value[at - 1] == '\t')) {
            return true;
        }
    }
    return false;
}

}  // namespace

diagnostics::Diagnostic IniReader::with_comment_hint(diagnostics::Diagnostic one) {
    if (!commented_.has_value()) {
        commented_.emplace();
        for (const IniEntry &entry : file_.entries()) {
            if (hasCommentAfter(entry.value)) {
                commented_->emplace(entry.place.file, entry.place.line);
            }
        }
    }
    const bool in_comment = commented_->contains({one.what.place.file, one.what.place.line});
    if (in_comment) {
        one.what.hint += one.what.hint.empty() ? "" : "; ";
        one.what.hint +=
            "# and ; begin a comment only at the start of a line: write the comment on a separate line";
    }
    return one;
}

void IniReader::know(std::string_view section, std::string_view key) {
    known_[std::string(section)].insert(std::string(key));
}

void IniReader::declare_row(std::string_view section, const IniKey &key) {
    know(section, key.name);
    if (key.effect != IniEffect::NONE) {
        return;
    }
    const IniEntry *entry = file_.find(section, key.name);
    const std::vector<std::string> harmless = split_words(key.words);
    if (entry != nullptr && std::ranges::find(harmless, entry->value) == harmless.end()) {
        without_effect_.insert_or_assign(label(section, key.name), std::string(key.doc));
    }
}

void IniReader::declare(std::span<const IniKey> keys) {
    for (const IniKey &key : keys) {
        if (!key.section.ends_with('*')) {
            declare_row(key.section, key);
        }
    }
}

void IniReader::declare_in(std::string_view section, std::string_view pattern, std::span<const IniKey> keys) {
    for (const IniKey &key : keys) {
        if (key.section == pattern) {
            declare_row(section, key);
        }
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

const IniEntry *IniReader::find(const IniKey &key, std::string_view section) const {
    return file_.find(name_of(key, section), key.name);
}

const IniEntry *IniReader::scalar(const IniKey &key, std::string_view section) {
    know(section, key.name);
    const IniEntry *first = file_.find(section, key.name);
    const IniEntry *second = file_.find(section, key.name, 2);
    if (second != nullptr && warned_twice_.insert(label(section, key.name)).second) {
        sink_.warning(label(section, key.name) + " appears twice; the first one, '" + first->value + "' in " +
                          first->place.str() + ", is used",
                      second->place);
    }
    return first;
}

void IniReader::missing(std::string_view section, const IniKey &key, const std::string &expected) {
    const bool has_section = file_.hasSection(section);
    if (!key.required || (!has_section && !missing_sections_.insert(std::string(section)).second)) {
        return;  // one message for the section
    }
    const std::string near = nearest_name(key.name, file_.keys(section));
    sink_.error(has_section ? label(section, key.name) + " is missing"
                            : "section [" + std::string(section) + "] is missing",
                file_.place_of_section(section),
                "expected " + label(section, key.name) + " = " + expected +
                    (near.empty() ? "" : "; is '" + near + "' a misspelling?"));
}

std::optional<double> IniReader::number(const IniEntry &entry, const IniKey &key) {
    const std::vector<std::string> words = split_words(entry.value);
    const auto value = words.empty() ? std::nullopt : parse_double(words[0]);
    const bool is_comment_after = words.size() > 1 && (words[1][0] == '#' || words[1][0] == ';');
    if (!value.has_value() || (words.size() > 1 && !is_comment_after)) {
        sink_.error(label(entry.section, entry.key) + " = '" + entry.value + "' is not a number", entry.place,
                    "expected " + describe_number(key) + ", with a decimal point");
        return std::nullopt;
    }
    if (*value < key.lowest || *value > key.highest) {
        sink_.error(label(entry.section, entry.key) + " = " + entry.value + " is out of range", entry.place,
                    "expected " + describe_number(key));
        return std::nullopt;
    }
    return value;
}

std::optional<std::int64_t> IniReader::whole(const IniEntry &entry, const IniKey &key) {
    const std::vector<std::string> words = split_words(entry.value);
    auto value = words.empty() ? std::nullopt : parse_int(words[0]);
    if (!value.has_value() && !words.empty()) {
        // "1.0" is accepted as a whole number.
        const auto real = parse_double(words[0]);
        // A double holds whole numbers exactly only up to 2^53.
        constexpr double LARGEST = 9007199254740992.0;
        if (real.has_value() && std::fabs(*real) <= LARGEST && *real == std::floor(*real)) {
            value = static_cast<std::int64_t>(*real);
        }
    }
    const bool is_comment_after = words.size() > 1 && (words[1][0] == '#' || words[1][0] == ';');
    if (!value.has_value() || (words.size() > 1 && !is_comment_after)) {
        sink_.error(label(entry.section, entry.key) + " = '" + entry.value + "' is not a whole number",
                    entry.place, "expected " + describe_whole(key));
        return std::nullopt;
    }
    const auto size = static_cast<double>(*value);
    if (size < key.lowest || size > key.highest) {
        sink_.error(label(entry.section, entry.key) + " = " + entry.value + " is out of range", entry.place,
                    "expected " + describe_whole(key));
        return std::nullopt;
    }
    return value;
}

double IniReader::real(const IniKey &key, std::string_view section, std::optional<double> preset) {
    const IniEntry *entry = scalar(key, name_of(key, section));
    if (entry == nullptr) {
        missing(name_of(key, section), key, describe_number(key));
        return preset.value_or(key.preset);
    }
    return number(*entry, key).value_or(preset.value_or(key.preset));
}

std::int64_t IniReader::integer(const IniKey &key, std::string_view section,
                                std::optional<std::int64_t> preset) {
    const std::int64_t instead = preset.value_or(static_cast<std::int64_t>(key.preset));
    const IniEntry *entry = scalar(key, name_of(key, section));
    if (entry == nullptr) {
        missing(name_of(key, section), key, describe_whole(key));
        return instead;
    }
    return whole(*entry, key).value_or(instead);
}

bool IniReader::boolean(const IniKey &key, std::string_view section) {
    const bool preset = key.preset != 0;
    const IniEntry *entry = scalar(key, name_of(key, section));
    if (entry == nullptr) {
        missing(name_of(key, section), key, "yes or no");
        return preset;
    }
    const std::vector<std::string> words = split_words(entry->value);
    if (const auto truth = ini_bool(words.empty() ? "" : words[0])) {
        return *truth;
    }
    sink_.error(label(entry->section, entry->key) + " = '" + entry->value + "' is not a yes or no value",
                entry->place, "expected YES, TRUE or 1, or NO, FALSE or 0");
    return preset;
}

std::string IniReader::text(const IniKey &key, std::string_view section) {
    const IniEntry *entry = scalar(key, name_of(key, section));
    if (entry == nullptr || (entry->value.empty() && key.required)) {
        missing(name_of(key, section), key, "a text");
        return std::string(key.text);
    }
    return entry->value;
}

std::string IniReader::choice(const IniKey &key, std::string_view section) {
    const IniEntry *entry = scalar(key, name_of(key, section));
    if (entry == nullptr) {
        missing(name_of(key, section), key, "one of " + std::string(key.words));
        return std::string(key.text);
    }
    std::string all;
    for (const std::string &one : split_words(key.words)) {
        if (equals_ignoring_case(one, entry->value)) {
            return one;
        }
        all += (all.empty() ? "" : ", ") + one;
    }
    sink_.error(label(entry->section, entry->key) + " = '" + entry->value + "' is not a known value",
                entry->place, "expected one of " + all);
    return std::string(key.text);
}

std::vector<const IniEntry *> IniReader::list(const IniKey &key, std::string_view section) {
    const std::string_view name = name_of(key, section);
    know(name, key.name);
    std::vector<const IniEntry *> entries = file_.find_all(name, key.name);
    if (entries.empty()) {
        missing(name, key, "a text");
    }
    return entries;
}

/// Reports sections whose name is a misspelling of a known one.
void IniReader::report_sections(diagnostics::Severity severity) {
    std::vector<std::string> names;
    for (const auto &[name, keys] : known_) {
        names.push_back(name);
    }
    for (const std::string &section : file_.sections()) {
        const bool intended =
            known_.count(section) > 0 || open_.count(section) > 0 || used_sections_.count(section) > 0;
        const std::string near = intended ? "" : nearest_name(section, names);
        if (!near.empty() && used_sections_.insert(section).second) {
            sink_.report({severity,
                          {"unknown section [" + section + "]; it has no effect",
                           file_.place_of_section(section), "did you mean [" + near + "]?"}});
        }
    }
}

void IniReader::report_unknown(bool strict) {
    const diagnostics::Severity severity =
        strict ? diagnostics::Severity::ERROR : diagnostics::Severity::WARNING;
    for (const IniEntry &entry : file_.entries()) {
        SourcePlace place = entry.place;
        place.column = 1;
        const auto why = without_effect_.find(label(entry.section, entry.key));
        if (why != without_effect_.end()) {
            sink_.report({severity, {why->first + " has no effect: " + why->second, place, {}}});
            without_effect_.erase(why);  // reported once
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

}  // namespace mw::ini
