// SPDX-License-Identifier: GPL-2.0-or-later
// Lists of the objects of an instance.
#include <fnmatch.h>

#include <algorithm>
#include <cerrno>

#include "hal/core/detail/impl.hh"

namespace mw::hal {

using namespace detail;

namespace {

bool isMatch(std::string_view glob, const std::string &name) {
    return glob == "*" || ::fnmatch(std::string(glob).c_str(), name.c_str(), 0) == 0;
}

template <class Info>
bool isListed(std::string_view glob, const Info &info) {
    return isMatch(glob, info.name) || (!info.original_name.empty() && isMatch(glob, info.original_name));
}

template <class Info>
void sort_by_name(std::vector<Info> &list) {
    std::sort(list.begin(), list.end(), [](const Info &a, const Info &b) { return a.name < b.name; });
}

std::string shown_name(const Segment &segment, const Record &record, Offset alias) {
    const auto *other = segment.at<AliasRecord>(alias);
    return std::string(other != nullptr ? other->name_view() : record.name_view());
}

PinInfo info_of(const Hal::Impl &hal, const PinRecord &pin) {
    PinInfo info;
    info.name = shown_name(hal.segment, pin, pin.alias);
    info.original_name = pin.alias != 0 ? std::string(pin.name_view()) : std::string();
    info.type = pin.type;
    info.dir = pin.dir;
    info.owner = hal.comp_name(pin.comp);
    info.owner_id = hal.comp_id(pin.comp);
    if (const auto *signal = hal.segment.at<SignalRecord>(pin.signal)) {
        info.signal = signal->name_view();
    }
    info.value = hal.read(pin.type, hal.value_of(pin));
    return info;
}

ParamInfo info_of(const Hal::Impl &hal, const ParamRecord &param) {
    ParamInfo info;
    info.name = shown_name(hal.segment, param, param.alias);
    info.original_name = param.alias != 0 ? std::string(param.name_view()) : std::string();
    info.type = param.type;
    info.dir = param.dir;
    info.owner = hal.comp_name(param.comp);
    info.owner_id = hal.comp_id(param.comp);
    info.value = hal.read(param.type, param.address);
    return info;
}

SignalInfo info_of(const Hal::Impl &hal, const SignalRecord &signal) {
    SignalInfo info;
    info.name = signal.name_view();
    info.type = signal.type;
    info.value = hal.read(signal.type, signal.value);
    info.readers = signal.readers;
    info.writers = signal.writers;
    info.bidirectionals = signal.bidirectionals;
    return info;
}

CompInfo info_of(const Hal::Impl &hal, const CompRecord &comp) {
    CompInfo info;
    info.name = comp.name_view();
    info.id = comp.id;
    info.type = comp.type;
    info.isReady = comp.isReady;
    info.pid = comp.process.pid;
    info.is_loaded_by_loadrt = comp.is_loaded_by_loadrt;
    if (const char *args = hal.segment.at<char>(comp.insmod_args)) {
        info.insmod_args = args;
    }
    return info;
}

}  // namespace

std::vector<PinInfo> Hal::pins(std::string_view glob) const {
    std::vector<PinInfo> list;
    {
        Guard guard(*impl_);
        impl_->segment.each<PinRecord>(Kind::PIN, [&](PinRecord &pin) {
            PinInfo info = info_of(*impl_, pin);
            if (isListed(glob, info)) {
                list.push_back(std::move(info));
            }
        });
    }
    sort_by_name(list);
    return list;
}

std::vector<ParamInfo> Hal::params(std::string_view glob) const {
    std::vector<ParamInfo> list;
    {
        Guard guard(*impl_);
        impl_->segment.each<ParamRecord>(Kind::PARAM, [&](ParamRecord &param) {
            ParamInfo info = info_of(*impl_, param);
            if (isListed(glob, info)) {
                list.push_back(std::move(info));
            }
        });
    }
    sort_by_name(list);
    return list;
}

std::vector<SignalInfo> Hal::signals(std::string_view glob) const {
    std::vector<SignalInfo> list;
    std::vector<std::pair<std::string, SignalPin>> linked;
    {
        Guard guard(*impl_);
        impl_->segment.each<SignalRecord>(Kind::SIGNAL, [&](SignalRecord &signal) {
            if (isMatch(glob, std::string(signal.name_view()))) {
                list.push_back(info_of(*impl_, signal));
            }
        });
        impl_->segment.each<PinRecord>(Kind::PIN, [&](PinRecord &pin) {
            if (const auto *signal = impl_->segment.at<SignalRecord>(pin.signal)) {
                linked.emplace_back(signal->name_view(),
                                    SignalPin{shown_name(impl_->segment, pin, pin.alias), pin.dir});
            }
        });
    }
    sort_by_name(list);
    std::sort(linked.begin(), linked.end(), [](const auto &a, const auto &b) {
        return a.first != b.first ? a.first < b.first : a.second.name < b.second.name;
    });
    for (SignalInfo &info : list) {
        auto at =
            std::lower_bound(linked.begin(), linked.end(), info.name,
                             [](const auto &entry, const std::string &name) { return entry.first < name; });
        for (; at != linked.end() && at->first == info.name; ++at) {
            info.pins.push_back(at->second);
        }
    }
    return list;
}

std::vector<FunctInfo> Hal::functs(std::string_view glob) const {
    std::vector<FunctInfo> list;
    {
        Guard guard(*impl_);
        impl_->segment.each<FunctRecord>(Kind::FUNCT, [&](FunctRecord &funct) {
            FunctInfo info;
            info.name = funct.name_view();
            info.owner = impl_->comp_name(funct.comp);
            info.owner_id = impl_->comp_id(funct.comp);
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

std::vector<ThreadInfo> Hal::threads(std::string_view glob) const {
    std::vector<ThreadInfo> list;
    Guard guard(*impl_);
    impl_->publish_figures();
    const Segment &segment = impl_->segment;
    segment.each<ThreadRecord>(Kind::THREAD, [&](ThreadRecord &thread) {
        ThreadInfo info;
        info.name = thread.name_view();
        if (!isMatch(glob, info.name)) {
            return;
        }
        info.period_ns = thread.period_ns;
        info.owner_id = impl_->comp_id(thread.comp);
        info.overruns = thread.overruns.load();
        info.max_latency_ns = thread.max_latency_ns.load();
        info.tmax_ns = thread.tmax;
        if (const PinRecord *time = impl_->find_pin(info.name + ".time")) {
            info.time_ns = impl_->read(Type::S32, impl_->value_of(*time)).as_s32();
        }
        const auto &functions = *segment.at<FunctionList>(thread.lists[thread.active.load()]);
        for (std::uint32_t i = 0; i < functions.count; ++i) {
            const ListEntry &entry = functions.entries[i];
            (entry.is_init ? info.init_functions : info.functions)
                .emplace_back(segment.at<FunctRecord>(entry.funct)->name_view());
        }
        list.push_back(std::move(info));
    });
    std::stable_sort(list.begin(), list.end(), [](const ThreadInfo &a, const ThreadInfo &b) {
        return a.period_ns != b.period_ns ? a.period_ns < b.period_ns : a.name < b.name;
    });
    return list;
}

std::vector<CompInfo> Hal::components(std::string_view glob) const {
    std::vector<CompInfo> list;
    {
        Guard guard(*impl_);
        impl_->segment.each<CompRecord>(Kind::COMP, [&](CompRecord &comp) {
            if (isMatch(glob, std::string(comp.name_view()))) {
                list.push_back(info_of(*impl_, comp));
            }
        });
    }
    sort_by_name(list);
    return list;
}

Result<PinInfo> Hal::pin(std::string_view name) const {
    Guard guard(*impl_);
    const PinRecord *pin = impl_->find_pin(name);
    if (pin == nullptr) {
        return impl_->no_such(Kind::PIN, name);
    }
    return info_of(*impl_, *pin);
}

bool Hal::hasPin(std::string_view name) const {
    Guard guard(*impl_);
    return impl_->find_pin(name) != nullptr;
}

bool Hal::hasParam(std::string_view name) const {
    Guard guard(*impl_);
    return impl_->find_param(name) != nullptr;
}

bool Hal::hasSignal(std::string_view name) const {
    Guard guard(*impl_);
    return impl_->find_signal(name) != nullptr;
}

bool Hal::hasComponent(std::string_view name) const {
    Guard guard(*impl_);
    return impl_->segment.find(Kind::COMP, name) != nullptr;
}

Result<ParamInfo> Hal::param(std::string_view name) const {
    Guard guard(*impl_);
    const ParamRecord *param = impl_->find_param(name);
    if (param == nullptr) {
        return impl_->no_such(Kind::PARAM, name);
    }
    return info_of(*impl_, *param);
}

Result<SignalInfo> Hal::signal(std::string_view name) const {
    Guard guard(*impl_);
    const SignalRecord *signal = impl_->find_signal(name);
    if (signal == nullptr) {
        return impl_->no_such(Kind::SIGNAL, name);
    }
    SignalInfo info = info_of(*impl_, *signal);
    const Offset offset = impl_->segment.offset_of(signal);
    impl_->segment.each<PinRecord>(Kind::PIN, [&](PinRecord &pin) {
        if (pin.signal == offset) {
            info.pins.push_back({shown_name(impl_->segment, pin, pin.alias), pin.dir});
        }
    });
    sort_by_name(info.pins);
    return info;
}

Result<CompInfo> Hal::component(std::string_view name) const {
    Guard guard(*impl_);
    const auto *comp = impl_->segment.find_as<CompRecord>(Kind::COMP, name);
    if (comp == nullptr) {
        return impl_->no_such(Kind::COMP, name);
    }
    return info_of(*impl_, *comp);
}

Result<CompInfo> Hal::component(int comp_id) const {
    Guard guard(*impl_);
    const CompRecord *comp = impl_->find_comp(comp_id);
    if (comp == nullptr) {
        return refuse(ENOENT, fmt::format("there is no component with id {}", comp_id));
    }
    return info_of(*impl_, *comp);
}

HalStatistics Hal::statistics() const {
    Guard guard(*impl_);
    const Segment &segment = impl_->segment;
    const auto count = [&](Kind kind) {
        RecordCount records{static_cast<int>(segment.table(kind).count), 0};
        for (Offset at = segment.table(kind).free; at != 0; at = segment.at<Record>(at)->next) {
            ++records.recycled;
        }
        return records;
    };
    HalStatistics statistics;
    statistics.segment_bytes = segment.header().top;
    statistics.capacity_bytes = RESERVE;
    statistics.components = count(Kind::COMP);
    statistics.pins = count(Kind::PIN);
    const RecordCount pin_aliases = count(Kind::PIN_ALIAS);
    const RecordCount param_aliases = count(Kind::PARAM_ALIAS);
    statistics.aliases = {pin_aliases.active + param_aliases.active,
                          pin_aliases.recycled + param_aliases.recycled};
    statistics.signals = count(Kind::SIGNAL);
    statistics.params = count(Kind::PARAM);
    statistics.functs = count(Kind::FUNCT);
    statistics.threads = count(Kind::THREAD);
    return statistics;
}

}  // namespace mw::hal
