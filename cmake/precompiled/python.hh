// SPDX-License-Identifier: GPL-2.0-or-later
// As standard.hh, for Python extensions.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include "standard.hh"
