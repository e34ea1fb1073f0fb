// SPDX-License-Identifier: GPL-2.0-or-later
// threads: creates up to three realtime threads; it has no pins and may be unloaded afterwards.
// `name1=`, `period1=` [ns] to `name3=`, `period3=`, fastest first; without a name one thread "thread1" of 1
// ms. `fp1=` to `fp3=` are accepted: every thread may use floating point.
#include "hal/sdk/component.hh"

static char *name1 = nullptr;
RTAPI_MP_STRING(name1, "name of the first thread");
static long period1 = 0;
RTAPI_MP_LONG(period1, "period of the first thread [ns]");
static int fp1 = 1;
RTAPI_MP_INT(fp1, "ignored: threads always support floating point");
static char *name2 = nullptr;
RTAPI_MP_STRING(name2, "name of the second thread");
static long period2 = 0;
RTAPI_MP_LONG(period2, "period of the second thread [ns]");
static int fp2 = 1;
RTAPI_MP_INT(fp2, "ignored: threads always support floating point");
static char *name3 = nullptr;
RTAPI_MP_STRING(name3, "name of the third thread");
static long period3 = 0;
RTAPI_MP_LONG(period3, "period of the third thread [ns]");
static int fp3 = 1;
RTAPI_MP_INT(fp3, "ignored: threads always support floating point");

namespace mw::components {
using namespace sdk;

constexpr long DEFAULT_PERIOD_NS = 1000000;

struct Wanted {
    const char *name;
    long period_ns;
    int fp;
};

static bool isGiven(const Wanted &thread) noexcept {
    return thread.name != nullptr && thread.name[0] != '\0';
}

/// Rejects a set of threads that is incomplete or not in order. Returns 0, or a negated errno.
static int check(const Wanted *threads, int count) noexcept {
    for (int i = 0; i < count; ++i) {
        if (threads[i].period_ns <= 0) {
            rtapi_print_msg(RTAPI_MSG_ERR, "threads: thread '%s' needs a period%d= above 0 [ns]",
                            threads[i].name, i + 1);
            return -EINVAL;
        }
        if (i > 0 && threads[i].period_ns < threads[i - 1].period_ns) {
            rtapi_print_msg(RTAPI_MSG_ERR,
                            "threads: '%s' is faster than '%s' before it; the fastest comes first",
                            threads[i].name, threads[i - 1].name);
            return -EINVAL;
        }
    }
    return 0;
}

static int make_threads() noexcept {
    Wanted threads[] = {{name1, period1, fp1}, {name2, period2, fp2}, {name3, period3, fp3}};
    int count = 0;
    while (count < 3 && isGiven(threads[count])) {
        ++count;
    }
    if (count == 0) {
        threads[0] = {"thread1", period1 > 0 ? period1 : DEFAULT_PERIOD_NS, 1};
        count = 1;
    }
    int status = check(threads, count);
    int made = 0;
    for (int i = 0; i < count && status >= 0; ++i) {
        status = hal_create_thread(threads[i].name, static_cast<unsigned long>(threads[i].period_ns),
                                   threads[i].fp);
        made += status >= 0 ? 1 : 0;
    }
    for (int i = 0; i < made && status < 0; ++i) {
        hal_thread_delete(threads[i].name);
    }
    return status < 0 ? status : 0;
}

}  // namespace mw::components

static int mw_comp_id = -1;

int rtapi_app_main(void) {
    mw_comp_id = hal_init("threads");
    if (mw_comp_id < 0) {
        return mw_comp_id;
    }
    const int status = mw::components::make_threads();
    if (status < 0) {
        hal_exit(mw_comp_id);
        return status;
    }
    return hal_ready(mw_comp_id);
}

void rtapi_app_exit(void) {
    hal_exit(mw_comp_id);
}
