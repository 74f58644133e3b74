// SPDX-License-Identifier: BSD-3-Clause
#include <springfit/parallel/tbb.hpp>

int main() {
    int visits[4] = {0, 0, 0, 0};
    springfit::parallel::tbb(2).for_chunks(
        4, 1, [&](springfit::Index chunk, springfit::Index, springfit::Index) { ++visits[chunk]; });
    return visits[0] == 1 && visits[3] == 1 ? 0 : 1;
}
