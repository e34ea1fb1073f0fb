// SPDX-License-Identifier: GPL-2.0-or-later
// Orders for joints, axes and the probe.
#pragma once

#include "clients/rsh/orders.hh"

namespace mw::rsh {

Result<Waiting> home(const Ordered &o);
Result<Waiting> unhome(const Ordered &o);
Result<Waiting> wait_homed(const Ordered &o);
Result<Waiting> jog(const Ordered &o);
Result<Waiting> jog_increment(const Ordered &o);
Result<Waiting> jog_stop(const Ordered &o);
Result<Waiting> set_teleop(const Ordered &o);
Result<Waiting> set_feed_override(const Ordered &o);
Result<Waiting> override_limits(const Ordered &o);
Result<Waiting> probe(const Ordered &o);
Result<Waiting> clear_probe(const Ordered &o);

}  // namespace mw::rsh
