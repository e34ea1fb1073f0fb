// SPDX-License-Identifier: GPL-2.0-or-later
// hal.h: queries, and the instance.
#include <unistd.h>

#include <algorithm>
#include <cstring>
#include <deque>
#include <string>

#include "hal/capi/status.hh"
#include "runtime/log.hh"

using namespace mw;
using namespace mw::hal;
using namespace mw::hal::capi;
using namespace mw::hal::detail;

namespace {

/// Holds the texts of this thread's last query.
class Texts {
  public:
    void clear() { kept_.clear(); }
    const char *keep(const std::string &text) { return kept_.emplace_back(text).c_str(); }
    const char *keep_or_null(const std::string &text) { return text.empty() ? nullptr : keep(text); }

  private:
    std::deque<std::string> kept_;
};

Texts &texts() {
    thread_local Texts of_this_thread;
    return of_this_thread;
}

hal_query_value_u to_union(const Value &value) {
    hal_query_value_u out{};
    std::memcpy(&out, &value.bits, sizeof out);
    return out;
}

Value from_union(Type type, const hal_query_value_u &in) {
    switch (type) {
    case Type::BIT: return Value::of_bit(in.b);
    case Type::FLOAT: return Value::of_float(in.r);
    case Type::S32: return Value::of_s32(in.s32);
    case Type::U32: return Value::of_u32(in.u32);
    case Type::S64: return Value::of_s64(in.s);
    case Type::U64: return Value::of_u64(in.u);
    case Type::PORT: break;
    }
    Value port{Type::PORT, 0};
    std::memcpy(&port.bits, &in.p, sizeof in.p);
    return port;
}

template <class Info>
void fill_common(hal_query_pp_t &out, const Info &info) {
    out.name = texts().keep(info.name);
    out.alias = info.original_name.empty() ? nullptr : out.name;
    out.type = static_cast<hal_type_t>(info.type);
    out.dir = static_cast<hal_pdir_t>(info.dir);
    out.comp_id = info.owner_id;
    out.comp = texts().keep(info.owner);
    out.value = to_union(info.value);
}

void fill(hal_query_t &query, const PinInfo &info) {
    query.qtype = HAL_QTYPE_PIN;
    query.pp = {};
    fill_common(query.pp, info);
    query.pp.signal = texts().keep_or_null(info.signal);
    query.name = query.pp.name;
}

void fill(hal_query_t &query, const ParamInfo &info) {
    query.qtype = HAL_QTYPE_PARAM;
    query.pp = {};
    fill_common(query.pp, info);
    query.name = query.pp.name;
}

void fill(hal_query_t &query, const SignalInfo &info) {
    query.qtype = HAL_QTYPE_SIGNAL;
    query.sig = {};
    query.sig.name = query.name = texts().keep(info.name);
    query.sig.type = static_cast<hal_type_t>(info.type);
    query.sig.readers = info.readers;
    query.sig.writers = info.writers;
    query.sig.bidirs = info.bidirectionals;
    query.sig.value = to_union(info.value);
}

void fill(hal_query_t &query, const CompInfo &info) {
    query.qtype = HAL_QTYPE_COMP;
    query.comp = {};
    query.comp.name = query.name = texts().keep(info.name);
    query.comp.comp_id = info.id;
    query.comp.type = static_cast<hal_comp_type_t>(info.type);
    query.comp.pid = info.pid;
    query.comp.ready = info.isReady ? 1 : 0;
    query.comp.insmod = info.is_loaded_by_loadrt ? texts().keep(info.insmod_args) : nullptr;
}

void fill(hal_query_t &query, const FunctInfo &info) {
    query.qtype = HAL_QTYPE_FUNCT;
    query.funct = {};
    query.funct.name = query.name = texts().keep(info.name);
    query.funct.comp_id = info.owner_id;
    query.funct.comp = texts().keep(info.owner);
    query.funct.users = info.users;
    query.funct.reentrant = info.reentrant ? 1 : 0;
}

void fill(hal_query_t &query, const ThreadInfo &info) {
    query.qtype = HAL_QTYPE_THREAD;
    query.thread = {};
    query.thread.name = query.name = texts().keep(info.name);
    query.thread.comp_id = info.owner_id;
    query.thread.period_nsec = static_cast<long>(info.period_ns);
    query.thread.time_nsec = static_cast<long>(info.time_ns);
    query.thread.tmax_nsec = static_cast<long>(info.tmax_ns);
}

/// The pattern of a list query.
std::string pattern_of(const hal_query_t *query) {
    return query == nullptr || query->name == nullptr ? "*" : query->name;
}

bool wants(const hal_query_t *query, hal_qtype_t kind) {
    return query == nullptr || query->qtype == HAL_QTYPE_ANY || query->qtype == kind;
}

/// Calls back for each of `infos`; returns the first result other than 0.
template <class Info>
int call_each(const std::vector<Info> &infos, hal_query_cb cb, void *arg) {
    for (const Info &info : infos) {
        hal_query_t one{};
        fill(one, info);
        if (const int answer = cb(&one, arg); answer != 0) {
            return answer;
        }
    }
    return 0;
}

template <class Work>
int list(hal_query_cb cb, Work work) {
    if (cb == nullptr) {
        return -EINVAL;
    }
    return with_hal([&](Hal &hal) {
        texts().clear();
        return work(hal);
    });
}

/// Fills `query` with the pin or parameter of its name; a parameter takes precedence.
int look_up_p(const Hal &hal, hal_query_t &query) {
    if (query.name == nullptr) {
        return -EINVAL;
    }
    const std::string name = query.name;
    const bool wants_param = wants(&query, HAL_QTYPE_PARAM);
    const bool wants_pin = wants(&query, HAL_QTYPE_PIN);
    texts().clear();
    if (const auto param = hal.param(name); wants_param && param) {
        fill(query, *param);
        return 0;
    }
    if (const auto pin = hal.pin(name); wants_pin && pin) {
        fill(query, *pin);
        return 0;
    }
    query.name = texts().keep(name);
    return -ENOENT;
}

int look_up_s(const Hal &hal, hal_query_t &query) {
    if (query.name == nullptr) {
        return -EINVAL;
    }
    const std::string name = query.name;
    texts().clear();
    if (const auto signal = hal.signal(name)) {
        fill(query, *signal);
        return 0;
    }
    query.name = texts().keep(name);
    return -ENOENT;
}

rtapi_intptr_t reference_of(Hal &hal, const char *name, hal_type_t type) {
    const auto address = hal.address_of(name, static_cast<Type>(type));
    return address ? static_cast<rtapi_intptr_t>(hal.impl().segment.offset_of(const_cast<void *>(*address)))
                   : 0;
}

}  // namespace

extern "C" {

int hal_comp_by_id(int comp_id, hal_query_t *q) {
    return with_hal([&](Hal &hal) {
        const auto info = hal.component(comp_id);
        if (!info || q == nullptr) {
            return info ? -EINVAL : -ENOENT;
        }
        texts().clear();
        fill(*q, *info);
        return 0;
    });
}

int hal_comp_by_name(const char *name, hal_query_t *q) {
    return with_hal([&](Hal &hal) {
        const auto info = hal.component(name == nullptr ? "" : name);
        if (!info || q == nullptr) {
            return info ? -EINVAL : -ENOENT;
        }
        texts().clear();
        fill(*q, *info);
        return 0;
    });
}

int hal_list_comp(hal_query_t *q, hal_query_cb cb, void *arg) {
    const std::string pattern = pattern_of(q);
    return list(cb, [&](Hal &hal) { return call_each(hal.components(pattern), cb, arg); });
}

int hal_list_p(hal_query_t *q, hal_query_cb cb, void *arg) {
    const std::string pattern = pattern_of(q);
    return list(cb, [&](Hal &hal) {
        int answer = wants(q, HAL_QTYPE_PIN) ? call_each(hal.pins(pattern), cb, arg) : 0;
        if (answer == 0 && wants(q, HAL_QTYPE_PARAM)) {
            answer = call_each(hal.params(pattern), cb, arg);
        }
        return answer;
    });
}

int hal_list_s(hal_query_t *q, hal_query_cb cb, void *arg) {
    const std::string pattern = pattern_of(q);
    return list(cb, [&](Hal &hal) { return call_each(hal.signals(pattern), cb, arg); });
}

int hal_list_p_s(hal_query_t *q, hal_query_cb cb, void *arg) {
    if (q == nullptr || q->name == nullptr) {
        return -EINVAL;
    }
    const std::string name = q->name;
    return list(cb, [&](Hal &hal) {
        if (!hal.signal(name)) {
            return -ENOENT;
        }
        std::vector<PinInfo> linked = hal.pins();
        std::erase_if(linked, [&](const PinInfo &pin) { return pin.signal != name; });
        return call_each(linked, cb, arg);
    });
}

int hal_list_funct(hal_query_t *q, hal_query_cb cb, void *arg) {
    const std::string pattern = pattern_of(q);
    return list(cb, [&](Hal &hal) { return call_each(hal.functs(pattern), cb, arg); });
}

int hal_list_thread(hal_query_t *q, hal_query_cb cb, void *arg) {
    const std::string pattern = pattern_of(q);
    const bool wants_functions = q != nullptr && q->qtype == HAL_QTYPE_THREAD_FUNCT;
    return list(cb, [&](Hal &hal) {
        const std::vector<ThreadInfo> threads = hal.threads(pattern);
        if (!wants_functions) {
            return call_each(threads, cb, arg);
        }
        int answer = 0;
        for (const ThreadInfo &thread : threads) {
            const auto call = [&](const std::string &function, int position, bool is_init) {
                hal_query_t one{};
                fill(one, thread);
                one.qtype = HAL_QTYPE_THREAD_FUNCT;
                one.thread.funct = texts().keep(function);
                one.thread.position = position;
                one.thread.is_init = is_init ? 1 : 0;
                answer = answer != 0 ? answer : cb(&one, arg);
            };
            int position = 0;
            for (const std::string &function : thread.init_functions) {
                call(function, ++position, true);
            }
            position = 0;
            for (const std::string &function : thread.functions) {
                call(function, ++position, false);
            }
        }
        return answer;
    });
}

int hal_get_p(hal_query_t *query, hal_query_cb cb, void *arg) {
    return with_hal([&](Hal &hal) {
        const int status = query == nullptr ? -EINVAL : look_up_p(hal, *query);
        return status == 0 && cb != nullptr ? cb(query, arg) : status;
    });
}

int hal_get_s(hal_query_t *query, hal_query_cb cb, void *arg) {
    return with_hal([&](Hal &hal) {
        const int status = query == nullptr ? -EINVAL : look_up_s(hal, *query);
        return status == 0 && cb != nullptr ? cb(query, arg) : status;
    });
}

int hal_set_p(hal_query_t *query, hal_query_cb cb, void *arg) {
    return with_hal([&](Hal &hal) {
        if (query == nullptr) {
            return -EINVAL;
        }
        const hal_query_value_u asked = query->pp.value;
        if (const int status = look_up_p(hal, *query); status != 0) {
            return status;
        }
        if (cb == nullptr) {
            query->pp.value = asked;
        } else if (const int answer = cb(query, arg); answer != 0) {
            return answer;
        }
        const std::string name = query->pp.name;
        return status_of(hal.set(name, from_union(static_cast<Type>(query->pp.type), query->pp.value)));
    });
}

int hal_set_s(hal_query_t *query, hal_query_cb cb, void *arg) {
    return with_hal([&](Hal &hal) {
        if (query == nullptr) {
            return -EINVAL;
        }
        const hal_query_value_u asked = query->sig.value;
        if (const int status = look_up_s(hal, *query); status != 0) {
            return status;
        }
        if (cb == nullptr) {
            query->sig.value = asked;
        } else if (const int answer = cb(query, arg); answer != 0) {
            return answer;
        }
        const std::string name = query->sig.name;
        return status_of(
            hal.set_signal(name, from_union(static_cast<Type>(query->sig.type), query->sig.value)));
    });
}

int hal_getref_p(hal_query_t *query) {
    return with_hal([&](Hal &hal) {
        const int status = query == nullptr ? -EINVAL : look_up_p(hal, *query);
        if (status == 0) {
            query->pp.ref = reference_of(hal, query->pp.name, query->pp.type);
        }
        return status;
    });
}

int hal_getref_s(hal_query_t *query) {
    return with_hal([&](Hal &hal) {
        const int status = query == nullptr ? -EINVAL : look_up_s(hal, *query);
        if (status == 0) {
            query->sig.ref = reference_of(hal, query->sig.name, query->sig.type);
        }
        return status;
    });
}

void *hal_reference_map(rtapi_intptr_t ref) {
    Hal *hal = current();
    if (hal == nullptr || ref <= 0 || ref > static_cast<rtapi_intptr_t>(RESERVE)) {
        return nullptr;
    }
    void *address = hal->impl().segment.at<void>(static_cast<Offset>(ref));
    return hal->impl().segment.contains(address, sizeof(std::uint64_t)) ? address : nullptr;
}

int hal_reference_unmap(const void *ref) {
    const Hal *hal = current();
    return hal != nullptr && ref != nullptr && hal->impl().segment.contains(ref, 1) ? 0 : -EINVAL;
}

int hal_statistics(hal_statistics_t *sts) {
    return with_hal([&](Hal &hal) {
        if (sts == nullptr) {
            return -EINVAL;
        }
        const HalStatistics figures = hal.statistics();
        *sts = {};
        sts->components = figures.components.active;
        sts->pins = figures.pins.active;
        sts->params = figures.params.active;
        sts->signals = figures.signals.active;
        sts->functs = figures.functs.active;
        sts->threads = figures.threads.active;
        sts->aliases = figures.aliases.active;
        sts->memory_used = figures.segment_bytes;
        sts->memory_size = figures.capacity_bytes;
        return 0;
    });
}

// ---- constructors

int hal_set_constructor(int comp_id, constructor make) {
    return with_hal([&](Hal &hal) {
        if (!hal.component(comp_id) || make == nullptr) {
            return complain(EINVAL,
                            fmt::format("there is no component {}, or no constructor is given", comp_id));
        }
        Guard guard(hal.impl());
        hal.impl().constructors[comp_id] = make;
        return 0;
    });
}

int hal_comp_invoke_make(const char *compname, const char *newname, const char *arg) {
    return with_hal([&](Hal &hal) {
        if (compname == nullptr || newname == nullptr || *newname == '\0') {
            return complain(EINVAL, "a component and the name of the new instance are needed");
        }
        const auto comp = hal.component(compname);
        if (!comp) {
            return complain(comp.error());
        }
        if (comp->pid != ::getpid()) {
            return complain(EXDEV,
                            fmt::format("component '{}' lives in process {}, which alone can make instances",
                                        compname, comp->pid));
        }
        constructor make = nullptr;
        {
            Guard guard(hal.impl());
            const auto found = hal.impl().constructors.find(comp->id);
            make = found == hal.impl().constructors.end() ? nullptr : found->second;
        }
        if (make == nullptr) {
            return complain(ENOSYS,
                            fmt::format("component '{}' makes no instances once it is loaded", compname));
        }
        // Pins and functions can only be made while the component is not ready.
        const bool was_ready = comp->isReady;
        (void)hal.set_ready(comp->id, false);
        const int status = make(newname, arg == nullptr ? "" : arg);
        (void)hal.set_ready(comp->id, was_ready);
        return status;
    });
}

int hal_comp_insmod_args(const char *compname, const char *args) {
    return with_hal([&](Hal &hal) {
        const auto comp = hal.component(compname == nullptr ? "" : compname);
        return comp ? status_of(hal.set_insmod_args(comp->id, args == nullptr ? "" : args))
                    : complain(comp.error());
    });
}

hal_realtime_type_t hal_get_realtime_type(void) {
    return rtapi_get_realtime_type();
}

void hal_enforce_exact_base_period(void) {
    // Every thread already has exactly its period.
}

int hal_mutex_force_release(void) {
    return with_hal([](Hal &hal) {
        // Taking the lock repairs the segment if its holder has died.
        const Guard guard(hal.impl());
        return 0;
    });
}

}  // extern "C"
