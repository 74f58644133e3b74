// refused: Motion<2, double>.*Motion<3, double>
#include <springfit/fit/acceleration/objective.hpp>

using namespace springfit;

void wrong(const SpringNetwork<2, double>& network, const std::vector<Motion<3, double>>& motions) {
    (void)acceleration_problem<2, double>(network, motions);
}
