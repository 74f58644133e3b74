// Stands for a program of the reader's own: point masses between springs.
#include <springfit/body/spring_body.hpp>
#include <springfit/cases/clamp_sets.hpp>
#include <springfit/closed_form/van_gelder.hpp>
#include <springfit/mesh/structured.hpp>
#include <springfit/network/builders.hpp>
#include <springfit/network/damping.hpp>
#include <springfit/network/forces.hpp>

class Simulator {
public:
    using Nodes = springfit::Points<3, double>;

    Simulator() : m_network(network()), m_body(m_network) {}

    void set_state(const Nodes& positions, const Nodes& velocities) { m_body.write(positions, velocities); }
    void hold(const std::vector<int>& nodes) { m_body.set_clamped(nodes); }
    bool step(const Nodes& forces, double h) {
        const Nodes before = velocities();
        m_body.set_external_forces(forces);
        m_body.step(h);
        m_acceleration = (velocities() - before) / h;
        return m_acceleration.allFinite();
    }
    Nodes positions() const {
        Nodes result;
        m_body.read(result);
        return result;
    }
    Nodes velocities() const {
        Nodes positions, result;
        m_body.read(positions, result);
        return result;
    }
    const Nodes& accelerations() const { return m_acceleration; }

private:
    static springfit::SpringNetwork<3, double> network() {
        using namespace springfit;
        const auto mesh = tetrahedron_grid<double>({2, 4, 2}, {0.1, 0.2, 0.1});
        auto result = springs_along_edges(mesh, {.density = 1000.});
        result.stiffness = 1.3 * van_gelder(mesh, result.springs, {.young = 5e4, .poisson = 0.3}).stiffness;
        result.damping = stiffness_proportional_damping(result, 1e-4);
        return result;
    }

    springfit::SpringNetwork<3, double> m_network;
    springfit::SpringBody<3, double> m_body;
    Nodes m_acceleration;
};
Simulator simulator;
