// SPDX-License-Identifier: GPL-2.0-or-later
#include "hal/core/functions.hh"

#include <cerrno>

#include "hal/core/detail/names.hh"
#include "hal/core/detail/records.hh"

namespace mw::hal {

using namespace detail;

Result<> Functions::create(std::string_view name, const FunctionCode &code, int comp_id) {
    Guard guard(segment_);
    auto comp = comp_for_new(segment_, comp_id, name, "function");
    if (!comp) {
        return std::unexpected(comp.error());
    }
    if (auto checked = check_name(segment_, Kind::FUNCT, name); !checked) {
        return checked;
    }
    if ((*comp)->type != CompType::REALTIME || code.function == nullptr) {
        return refuse(EINVAL, fmt::format("function '{}': only realtime components have functions", name));
    }
    auto *funct = segment_.make<FunctRecord>(Kind::FUNCT, name);
    if (funct == nullptr) {
        return refuse(ENOMEM, fmt::format("function '{}': no HAL memory left", name));
    }
    funct->comp = segment_.offset_of(*comp);
    funct->reentrant = code.reentrant;
    funct->usesFloat = code.usesFloat;
    funct->function = reinterpret_cast<std::uint64_t>(code.function);
    funct->argument = reinterpret_cast<std::uint64_t>(code.argument);
    segment_.insert(Kind::FUNCT, *funct);
    // If the names of the three pins are too long, it is an error, too. Pins created so far are removed with
    // the component.
    const std::string prefix(name);
    auto made =
        add_pin(segment_, **comp,
                {prefix + ".time", Type::S32, Dir::OUT, reinterpret_cast<void **>(&funct->time_slot)});
    if (made) {
        made = add_param(segment_, **comp, {prefix + ".tmax", Type::S32, Dir::RW, &funct->tmax});
    }
    if (made) {
        made = add_param(segment_, **comp,
                         {prefix + ".tmax-increased", Type::BIT, Dir::RO, &funct->tmax_increased});
    }
    return made;
}

std::vector<FunctionInfo> Functions::list(std::string_view glob) const {
    std::vector<FunctionInfo> list;
    {
        Guard guard(segment_);
        segment_.each<FunctRecord>(Kind::FUNCT, [&](FunctRecord &funct) {
            FunctionInfo info;
            info.name = funct.name_view();
            if (const auto *owner = segment_.at<CompRecord>(funct.comp)) {
                info.owner = owner->name_view();
                info.owner_id = owner->id;
            }
            info.users = funct.users;
            info.reentrant = funct.reentrant;
            info.usesFloat = funct.usesFloat;
            info.address = funct.function;
            info.argument = funct.argument;
            if (isMatch(glob, info.name)) {
                list.push_back(std::move(info));
            }
        });
    }
    sort_by_name(list);
    return list;
}

}  // namespace mw::hal
