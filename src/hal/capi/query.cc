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

void fill(hal_query_t &query, const FunctionInfo &info) {
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

/// Returns the pattern of a list query.
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

/// Calls back for each object that `found(hal, pattern)` returns.
template <class Find>
int list(const hal_query_t *query, hal_query_cb cb, void *arg, Find found) {
    if (cb == nullptr) {
        return -EINVAL;
    }
    const std::string pattern = pattern_of(query);
    return with_hal([&](Instance &hal) {
        texts().clear();
        return call_each(found(hal, pattern), cb, arg);
    });
}

/// Fills `query` with `info`, if neither is null.
template <class Info>
int give(const Result<Info> &info, hal_query_t *query) {
    if (!info || query == nullptr) {
        return info ? -EINVAL : -ENOENT;
    }
    texts().clear();
    fill(*query, *info);
    return 0;
}

/// Pins and parameters: fills their part of a query, finds them and sets them. A parameter takes precedence.
struct PinsAndParams {
    static hal_query_pp_t &part(hal_query_t &query) { return query.pp; }
    static bool isFilled(Instance &hal, hal_query_t &query, const std::string &name) {
        const bool wants_param = wants(&query, HAL_QTYPE_PARAM);
        const bool wants_pin = wants(&query, HAL_QTYPE_PIN);
        return (wants_param && give(hal.params().find(name), &query) == 0) ||
               (wants_pin && give(hal.pins().find(name), &query) == 0);
    }
    static Result<> set(Instance &hal, const std::string &name, const Value &value) {
        return hal.values().set(name, value);
    }
};

/// As PinsAndParams, for signals.
struct OfSignals {
    static hal_query_sig_t &part(hal_query_t &query) { return query.sig; }
    static bool isFilled(Instance &hal, hal_query_t &query, const std::string &name) {
        return give(hal.signals().find(name), &query) == 0;
    }
    static Result<> set(Instance &hal, const std::string &name, const Value &value) {
        return hal.signals().set(name, value);
    }
};

/// Fills `query` with the object that has its name.
template <class Objects>
int look_up(Instance &hal, hal_query_t *query) {
    if (query == nullptr || query->name == nullptr) {
        return -EINVAL;
    }
    const std::string name = query->name;
    if (Objects::isFilled(hal, *query, name)) {
        return 0;
    }
    texts().clear();
    query->name = texts().keep(name);
    return -ENOENT;
}

template <class Objects>
int get(hal_query_t *query, hal_query_cb cb, void *arg) {
    return with_hal([&](Instance &hal) {
        const int status = look_up<Objects>(hal, query);
        return status == 0 && cb != nullptr ? cb(query, arg) : status;
    });
}

template <class Objects>
int set(hal_query_t *query, hal_query_cb cb, void *arg) {
    return with_hal([&](Instance &hal) {
        if (query == nullptr) {
            return -EINVAL;
        }
        auto &part = Objects::part(*query);
        const hal_query_value_u asked = part.value;
        if (const int status = look_up<Objects>(hal, query); status != 0) {
            return status;
        }
        if (cb == nullptr) {
            part.value = asked;
        } else if (const int answer = cb(query, arg); answer != 0) {
            return answer;
        }
        const std::string name = part.name;
        return status_of(Objects::set(hal, name, from_union(static_cast<Type>(part.type), part.value)));
    });
}

template <class Objects>
int get_reference(hal_query_t *query) {
    return with_hal([&](Instance &hal) {
        const int status = look_up<Objects>(hal, query);
        if (status == 0) {
            auto &part = Objects::part(*query);
            const auto address = hal.values().address_of(part.name, static_cast<Type>(part.type));
            part.ref = address ? static_cast<rtapi_intptr_t>(hal.memory().reference_of(*address)) : 0;
        }
        return status;
    });
}

/// Calls back for each function of a thread, in order.
int call_functions(const ThreadInfo &thread, hal_query_cb cb, void *arg) {
    int answer = 0;
    for (const bool is_init : {true, false}) {
        int position = 0;
        for (const std::string &function : is_init ? thread.init_functions : thread.functions) {
            hal_query_t one{};
            fill(one, thread);
            one.qtype = HAL_QTYPE_THREAD_FUNCT;
            one.thread.funct = texts().keep(function);
            one.thread.position = ++position;
            one.thread.is_init = is_init ? 1 : 0;
            answer = answer != 0 ? answer : cb(&one, arg);
        }
    }
    return answer;
}

}  // namespace

extern "C" {

int hal_comp_by_id(int comp_id, hal_query_t *q) {
    return with_hal([&](Instance &hal) { return give(hal.components().find(comp_id), q); });
}

int hal_comp_by_name(const char *name, hal_query_t *q) {
    return with_hal(
        [&](Instance &hal) { return give(hal.components().find(name == nullptr ? "" : name), q); });
}

/// hal_list_SUFFIX for the objects of REGISTRY.
#define MW_EXPORT_LIST(SUFFIX, REGISTRY)                                                                     \
    int hal_list_##SUFFIX(hal_query_t *q, hal_query_cb cb, void *arg) {                                      \
        return list(q, cb, arg,                                                                              \
                    [](Instance &hal, const std::string &pattern) { return hal.REGISTRY().list(pattern); }); \
    }

/// hal_get_SUFFIX, hal_set_SUFFIX and hal_getref_SUFFIX for OBJECTS.
#define MW_EXPORT_QUERY(SUFFIX, OBJECTS)                                                                     \
    int hal_get_##SUFFIX(hal_query_t *query, hal_query_cb cb, void *arg) {                                   \
        return get<OBJECTS>(query, cb, arg);                                                                 \
    }                                                                                                        \
    int hal_set_##SUFFIX(hal_query_t *query, hal_query_cb cb, void *arg) {                                   \
        return set<OBJECTS>(query, cb, arg);                                                                 \
    }                                                                                                        \
    int hal_getref_##SUFFIX(hal_query_t *query) {                                                            \
        return get_reference<OBJECTS>(query);                                                                \
    }

MW_EXPORT_LIST(comp, components)
MW_EXPORT_LIST(s, signals)
MW_EXPORT_LIST(funct, functions)
MW_EXPORT_QUERY(p, PinsAndParams)
MW_EXPORT_QUERY(s, OfSignals)

int hal_list_p(hal_query_t *q, hal_query_cb cb, void *arg) {
    if (cb == nullptr) {
        return -EINVAL;
    }
    const std::string pattern = pattern_of(q);
    return with_hal([&](Instance &hal) {
        texts().clear();
        int answer = wants(q, HAL_QTYPE_PIN) ? call_each(hal.pins().list(pattern), cb, arg) : 0;
        if (answer == 0 && wants(q, HAL_QTYPE_PARAM)) {
            answer = call_each(hal.params().list(pattern), cb, arg);
        }
        return answer;
    });
}

int hal_list_p_s(hal_query_t *q, hal_query_cb cb, void *arg) {
    if (q == nullptr || q->name == nullptr || cb == nullptr) {
        return -EINVAL;
    }
    const std::string name = q->name;
    return with_hal([&](Instance &hal) {
        texts().clear();
        if (!hal.signals().find(name)) {
            return -ENOENT;
        }
        std::vector<PinInfo> linked = hal.pins().list();
        std::erase_if(linked, [&](const PinInfo &pin) { return pin.signal != name; });
        return call_each(linked, cb, arg);
    });
}

int hal_list_thread(hal_query_t *q, hal_query_cb cb, void *arg) {
    if (cb == nullptr) {
        return -EINVAL;
    }
    const std::string pattern = pattern_of(q);
    const bool wants_functions = q != nullptr && q->qtype == HAL_QTYPE_THREAD_FUNCT;
    return with_hal([&](Instance &hal) {
        texts().clear();
        const std::vector<ThreadInfo> threads = hal.threads().list(pattern);
        int answer = wants_functions ? 0 : call_each(threads, cb, arg);
        for (const ThreadInfo &thread : threads) {
            answer = wants_functions && answer == 0 ? call_functions(thread, cb, arg) : answer;
        }
        return answer;
    });
}

void *hal_reference_map(rtapi_intptr_t ref) {
    Instance *hal = current();
    return hal == nullptr ? nullptr : hal->memory().checked_at(ref, sizeof(std::uint64_t));
}

int hal_reference_unmap(const void *ref) {
    Instance *hal = current();
    return hal != nullptr && ref != nullptr && hal->memory().contains(ref, 1) ? 0 : -EINVAL;
}

int hal_statistics(hal_statistics_t *sts) {
    return with_hal([&](Instance &hal) {
        if (sts == nullptr) {
            return -EINVAL;
        }
        const MemoryStatistics figures = hal.memory().statistics();
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
    return with_hal([&](Instance &hal) {
        if (!hal.components().find(comp_id) || make == nullptr) {
            return complain(EINVAL,
                            fmt::format("there is no component {}, or no constructor is given", comp_id));
        }
        hal.components().set_constructor(comp_id, make);
        return 0;
    });
}

int hal_comp_invoke_make(const char *compname, const char *newname, const char *arg) {
    return with_hal([&](Instance &hal) {
        if (compname == nullptr || newname == nullptr || *newname == '\0') {
            return complain(EINVAL, "a component and the name of the new instance are needed");
        }
        const auto comp = hal.components().find(compname);
        if (!comp) {
            return complain(comp.error());
        }
        if (comp->pid != ::getpid()) {
            return complain(EXDEV,
                            fmt::format("component '{}' lives in process {}, which alone can make instances",
                                        compname, comp->pid));
        }
        const constructor make = hal.components().constructor(comp->id);
        if (make == nullptr) {
            return complain(ENOSYS,
                            fmt::format("component '{}' makes no instances once it is loaded", compname));
        }
        // Pins and functions can only be made while the component is not ready.
        const bool was_ready = comp->isReady;
        (void)hal.components().set_ready(comp->id, false);
        const int status = make(newname, arg == nullptr ? "" : arg);
        (void)hal.components().set_ready(comp->id, was_ready);
        return status;
    });
}

int hal_comp_insmod_args(const char *compname, const char *args) {
    return with_hal([&](Instance &hal) {
        const auto comp = hal.components().find(compname == nullptr ? "" : compname);
        return comp ? status_of(hal.components().set_insmod_args(comp->id, args == nullptr ? "" : args))
                    : complain(comp.error());
    });
}

hal_realtime_type_t hal_get_realtime_type(void) {
    return rtapi_get_realtime_type();
}

void hal_enforce_exact_base_period(void) {
    // Every thread already has exactly the requested period.
}

int hal_mutex_force_release(void) {
    return with_hal([](Instance &hal) {
        // Taking the lock repairs the segment if its holder has died.
        hal.memory().repair();
        return 0;
    });
}

}  // extern "C"
