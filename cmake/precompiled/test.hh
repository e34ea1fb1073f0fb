// SPDX-License-Identifier: GPL-2.0-or-later
// As standard.hh, for tests.
#include <gtest/gtest.h>

#include "standard.hh"
