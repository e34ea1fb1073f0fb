// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/core/components.hh"

#include <cerrno>
#include <cstring>

#include "hal/core/controller_watches.hh"
#include "hal/core/detail/names.hh"
#include "hal/core/detail/records.hh"
#include "hal/core/instance.hh"

namespace mw::hal {

using namespace detail;

namespace {

CompInfo info_of(const Segment &segment, const CompRecord &comp) {
    CompInfo info;
    info.name = comp.name_view();
    info.id = comp.id;
    info.type = comp.type;
    info.isReady = comp.isReady;
    info.pid = comp.process.pid;
    info.is_loaded_by_loadrt = comp.is_loaded_by_loadrt;
    if (const char *args = segment.at<char>(comp.insmod_args)) {
        info.insmod_args = args;
    }
    return info;
}

/// `code` is the errno of the failure.
Result<CompRecord *> existing(const Segment &segment, int comp_id, int code) {
    CompRecord *comp = find_comp(segment, comp_id);
    if (comp == nullptr) {
        return refuse(code, fmt::format("there is no component with id {}", comp_id));
    }
    return comp;
}

}  // namespace

Result<int> Components::create(std::string_view name, CompType type) {
    Guard guard(segment_);
    if (auto checked = check_lock(segment_, LOCK_LOAD, "new components"); !checked) {
        return std::unexpected(checked.error());
    }
    return add_comp(segment_, name, type);
}

Result<> Components::set_ready(int comp_id, bool isReady) {
    Guard guard(segment_);
    const auto found = existing(segment_, comp_id, EINVAL);
    if (!found) {
        return std::unexpected(found.error());
    }
    CompRecord &comp = **found;
    if (comp.isReady == isReady) {
        return refuse(EINVAL, fmt::format("component '{}' is {} already", comp.name_view(),
                                          isReady ? "ready" : "not ready"));
    }
    comp.isReady = isReady;
    // Release: threads acquire this word every cycle, so they see the complete component, whichever process
    // adds its functions.
    segment_.header().running.fetch_or(0, std::memory_order_release);
    return {};
}

Result<> Components::remove(int comp_id) {
    Guard guard(segment_);
    const auto comp = existing(segment_, comp_id, EINVAL);
    if (!comp) {
        return std::unexpected(comp.error());
    }
    remove_comp(segment_, **comp, Outputs::AS_THEY_ARE);
    watches_.remove(comp_id);
    constructors_.erase(comp_id);
    return {};
}

Result<> Components::set_insmod_args(int comp_id, std::string_view args) {
    Guard guard(segment_);
    const auto comp = existing(segment_, comp_id, EINVAL);
    if (!comp) {
        return std::unexpected(comp.error());
    }
    (*comp)->is_loaded_by_loadrt = true;
    const Offset text = segment_.allocate(args.size() + 1);
    if (text == 0) {
        return refuse(ENOMEM, "no HAL memory left");
    }
    std::memcpy(segment_.at<char>(text), args.data(), args.size());
    (*comp)->insmod_args = text;
    return {};
}

std::vector<CompInfo> Components::list(std::string_view glob) const {
    std::vector<CompInfo> list;
    {
        Guard guard(segment_);
        segment_.each<CompRecord>(Kind::COMP, [&](CompRecord &comp) {
            if (isMatch(glob, std::string(comp.name_view()))) {
                list.push_back(info_of(segment_, comp));
            }
        });
    }
    sort_by_name(list);
    return list;
}

bool Components::has(std::string_view name) const {
    Guard guard(segment_);
    return segment_.find(Kind::COMP, name) != nullptr;
}

Result<CompInfo> Components::find(std::string_view name) const {
    Guard guard(segment_);
    const auto *comp = segment_.find_as<CompRecord>(Kind::COMP, name);
    if (comp == nullptr) {
        return no_such(segment_, Kind::COMP, name);
    }
    return info_of(segment_, *comp);
}

Result<CompInfo> Components::find(int comp_id) const {
    Guard guard(segment_);
    const auto comp = existing(segment_, comp_id, ENOENT);
    if (!comp) {
        return std::unexpected(comp.error());
    }
    return info_of(segment_, **comp);
}

char *Components::stored_name(int comp_id) const {
    Guard guard(segment_);
    CompRecord *comp = find_comp(segment_, comp_id);
    return comp == nullptr ? nullptr : comp->name.data();
}

int Components::next_id() const {
    Guard guard(segment_);
    return segment_.header().next_comp_id;
}

void Components::set_constructor(int comp_id, Constructor make) {
    Guard guard(segment_);
    constructors_[comp_id] = make;
}

Components::Constructor Components::constructor(int comp_id) const {
    Guard guard(segment_);
    const auto found = constructors_.find(comp_id);
    return found == constructors_.end() ? nullptr : found->second;
}

}  // namespace mw::hal
