/* SPDX-License-Identifier: GPL-2.0-or-later */
#ifndef CORPUS_TYPES_H
#define CORPUS_TYPES_H
struct corpus_data {
    int count;
    double sum;
};
static const double corpus_step = 0.25;
#endif
