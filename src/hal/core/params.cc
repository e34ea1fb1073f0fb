// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/core/params.hh"

#include "hal/core/detail/names.hh"
#include "hal/core/detail/records.hh"
#include "hal/core/instance.hh"

namespace mw::hal {

using namespace detail;

namespace {

ParamInfo info_of(const Segment &segment, const ParamRecord &param) {
    ParamInfo info;
    describe(segment, param, info);
    info.value = value_at(segment, param.type, param.address);
    return info;
}

}  // namespace

Result<> Params::create(std::string_view name, Type type, Dir dir, void *address, int comp_id) {
    Guard guard(segment_);
    auto comp = comp_for_new(segment_, comp_id, name, "parameter");
    if (!comp) {
        return std::unexpected(comp.error());
    }
    return add_param(segment_, **comp, {name, type, dir, address});
}

Result<> Params::set_alias(std::string_view name, std::string_view alias) {
    Guard guard(segment_);
    if (auto checked = check_lock(segment_, LOCK_CONFIG, "aliases"); !checked) {
        return checked;
    }
    ParamRecord *param = find_param(segment_, name);
    if (param == nullptr) {
        return no_such(segment_, Kind::PARAM, name);
    }
    return detail::set_alias(segment_, Kind::PARAM, Kind::PARAM_ALIAS, *param, alias);
}

std::vector<ParamInfo> Params::list(std::string_view glob) const {
    std::vector<ParamInfo> list;
    {
        Guard guard(segment_);
        segment_.each<ParamRecord>(Kind::PARAM, [&](ParamRecord &param) {
            ParamInfo info = info_of(segment_, param);
            if (isListed(glob, info)) {
                list.push_back(std::move(info));
            }
        });
    }
    sort_by_name(list);
    return list;
}

bool Params::has(std::string_view name) const {
    Guard guard(segment_);
    return find_param(segment_, name) != nullptr;
}

Result<ParamInfo> Params::find(std::string_view name) const {
    Guard guard(segment_);
    const ParamRecord *param = find_param(segment_, name);
    if (param == nullptr) {
        return no_such(segment_, Kind::PARAM, name);
    }
    return info_of(segment_, *param);
}

Result<Value> Params::get(std::string_view name) const {
    Guard guard(segment_);
    const ParamRecord *param = find_param(segment_, name);
    if (param == nullptr) {
        return no_such(segment_, Kind::PARAM, name);
    }
    return value_at(segment_, param->type, param->address);
}

}  // namespace mw::hal
