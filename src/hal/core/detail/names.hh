// SPDX-License-Identifier: GPL-2.0-or-later
// Names in the tables of a segment: checks, messages and patterns. The caller holds the segment's lock.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/core.h>

#include "base/result.hh"
#include "hal/core/detail/segment.hh"

namespace mw::hal::detail {

/// A failure with the code that the C API returns.
std::unexpected<Error> refuse(int code, std::string message, std::string hint = {});

/// The name must have a valid length and must not be in use, also not as an alias.
Result<> check_name(const Segment &segment, Kind kind, std::string_view name);
/// HAL must not be locked against `what`, or the result is an error.
Result<> check_lock(const Segment &segment, std::uint8_t lock, const char *what);
/// "there is no pin 'x'", with the nearest name as the hint.
std::unexpected<Error> no_such(const Segment &segment, Kind kind, std::string_view name);
/// As no_such() for a name of a pin or a parameter.
std::unexpected<Error> no_such_value(const Segment &segment, std::string_view name);

bool isMatch(std::string_view glob, const std::string &name);
/// The alias, or the name if there is no alias.
std::string shown_name(const Segment &segment, const Record &record, Offset alias);

/// Sets name, original name, type, direction and owner of a pin or parameter.
template <class Info, class T>
void describe(const Segment &segment, const T &record, Info &info) {
    info.name = shown_name(segment, record, record.alias);
    info.original_name = record.alias != 0 ? std::string(record.name_view()) : std::string();
    info.type = record.type;
    info.dir = record.dir;
    if (const auto *owner = segment.at<CompRecord>(record.comp)) {
        info.owner = owner->name_view();
        info.owner_id = owner->id;
    }
}

template <class Info>
bool isListed(std::string_view glob, const Info &info) {
    return isMatch(glob, info.name) || (!info.original_name.empty() && isMatch(glob, info.original_name));
}

template <class Info>
void sort_by_name(std::vector<Info> &list) {
    std::sort(list.begin(), list.end(), [](const Info &a, const Info &b) { return a.name < b.name; });
}

/// Sets the alias of a pin or parameter; an empty one removes it.
template <class T>
Result<> set_alias(Segment &segment, Kind kind, Kind alias_kind, T &target, std::string_view alias) {
    if (!alias.empty()) {
        if (auto checked = check_name(segment, kind, alias); !checked) {
            return checked;
        }
    }
    if (auto *old = segment.at<AliasRecord>(target.alias)) {
        target.alias = 0;
        segment.remove(alias_kind, *old);
    }
    if (alias.empty()) {
        return {};
    }
    auto *record = segment.make<AliasRecord>(alias_kind, alias);
    if (record == nullptr) {
        return refuse(ENOMEM, fmt::format("alias '{}': no HAL memory left", alias));
    }
    record->target = segment.offset_of(&target);
    segment.insert(alias_kind, *record);
    target.alias = segment.offset_of(record);
    return {};
}

}  // namespace mw::hal::detail
