// refused: SpringBody<3, double> .*SpringNetwork<2, double>
#include <springfit/body/spring_body.hpp>

void wrong(const springfit::SpringNetwork<2, double>& network) {
    springfit::SpringBody<3, double> body(network);
}
