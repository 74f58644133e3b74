// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include <Eigen/Eigenvalues>

#include <springfit/cases/specimen.hpp>

namespace springfit::detail {

/// Draws random fields of force on a body. All of it goes by positions, none of it by node numbers.
template <int Dim, std::floating_point Scalar>
class LoadFieldSampler {
public:
    using Point = Vector<Dim, Scalar>;
    using Field = Points<Dim, Scalar>;

    LoadFieldSampler(const Specimen<Dim, Scalar>& body, const std::vector<int>& clamped)
        : m_body(&body), m_is_held(static_cast<std::size_t>(body.n_nodes()), false) {
        for (int node : clamped) {
            m_is_held[static_cast<std::size_t>(node)] = true;
        }
        for (int node : body.surface) {
            if (!m_is_held[static_cast<std::size_t>(node)]) {
                m_free_surface_nodes.push_back(node);
            }
        }
        m_low = x().rowwise().minCoeff();
        m_high = x().rowwise().maxCoeff();
        m_size = (m_high - m_low).norm();
        take_directions(clamped);
    }

    [[nodiscard]] bool is_held(Index node) const { return m_is_held[static_cast<std::size_t>(node)]; }
    /// Surface nodes that are not clamped.
    [[nodiscard]] const std::vector<int>& free_surface_nodes() const { return m_free_surface_nodes; }

    [[nodiscard]] Field uniform(std::mt19937& random) const { return direction(random).replicate(1, x().cols()); }

    [[nodiscard]] Field waves(std::mt19937& random) const {
        Field field = Field::Zero(Dim, x().cols());
        for (int wave = 0; wave < 3; ++wave) {
            std::uniform_real_distribution<Scalar> phase(0, 2 * std::numbers::pi_v<Scalar>);
            const Point along = direction(random);
            const Point wave_vector =
                std::numbers::pi_v<Scalar> / m_size * static_cast<Scalar>(wave + 1) * direction(random);
            const Scalar shift = phase(random);
            for (Index i = 0; i < field.cols(); ++i) {
                field.col(i) += std::sin(wave_vector.dot(x().col(i) - centre()) + shift) * along;
            }
        }
        return field;
    }

    [[nodiscard]] Field patch(std::mt19937& random) const {
        Field field = Field::Zero(Dim, x().cols());
        const Point middle = x().col(nearest(point(random)));
        const Point along = direction(random);
        const Scalar size = std::max(radius(random), least_radius(middle));
        for (int node : m_free_surface_nodes) {
            field.col(node) = weight(node, middle, size) * along;
        }
        return field;
    }

    /// Two patches drawn apart along the line between the middles of their forces, of which neither force nor moment is
    /// left over.
    [[nodiscard]] Field pull(std::mt19937& random) const {
        const Point one = x().col(nearest(point(random)));
        Point other = one;
        for (int attempt = 0; attempt < 10 && (one - other).norm() < m_size / 3; ++attempt) {
            other = x().col(nearest(point(random)));
        }
        if ((one - other).norm() < m_size / 3) {
            for (int node : m_free_surface_nodes) {
                if ((x().col(node) - one).norm() > (other - one).norm()) {
                    other = x().col(node);
                }
            }
        }
        require((one - other).norm() > 0, "body", "free surface nodes apart from each other", "none");
        Field field = Field::Zero(Dim, x().cols());
        const Point ends[2] = {one, other};
        const Scalar size = std::max({radius(random), least_radius(one), least_radius(other)});
        Scalar totals[2] = {0, 0};
        Point middles[2] = {Point::Zero(), Point::Zero()};
        for (int end = 0; end < 2; ++end) {
            for (int node : m_free_surface_nodes) {
                const Scalar share = m_body->masses(node) * weight(node, ends[end], size);
                totals[end] += share;
                middles[end] += share * x().col(node);
            }
            middles[end] /= totals[end];
        }
        const Point along = (middles[1] - middles[0]).normalized();
        const Scalar force = std::min(totals[0], totals[1]);
        for (int node : m_free_surface_nodes) {
            field.col(node) =
                (force / totals[1] * weight(node, ends[1], size) - force / totals[0] * weight(node, ends[0], size)) *
                along;
        }
        return field;
    }

    [[nodiscard]] Field stretch(std::mt19937& random) const {
        return growing(random, (m_away + Scalar(0.2) * direction(random)).normalized());
    }

    [[nodiscard]] Field bend(std::mt19937& random) const {
        Point across;
        do {
            across = direction(random);
            across -= m_away.dot(across) * m_away;
        } while (!(across.norm() > Scalar(0.1)));
        return growing(random, across.normalized());
    }

    [[nodiscard]] Field twist(std::mt19937& random) const {
        Vector<3, Scalar> axis = Vector<3, Scalar>::UnitZ();
        Point middle = centre();
        if (Dim == 2 || m_is_flat) {
            middle = point(random);
        }
        if constexpr (Dim == 3) {
            axis = m_is_flat ? m_normal : (m_away + Scalar(0.5) * direction(random)).normalized();
        }
        const Scalar square = part(random);
        Field field(Dim, x().cols());
        for (Index i = 0; i < field.cols(); ++i) {
            Vector<3, Scalar> arm = Vector<3, Scalar>::Zero();
            arm.template head<Dim>() = (x().col(i) - middle) / m_size;
            field.col(i) = profile(i, square) * axis.cross(arm).template head<Dim>();
        }
        return field;
    }

    [[nodiscard]] Field press(std::mt19937& random) const {
        const Point along = direction(random);
        Scalar low = std::numeric_limits<Scalar>::max();
        Scalar high = std::numeric_limits<Scalar>::lowest();
        for (int node : m_free_surface_nodes) {
            low = std::min(low, along.dot(x().col(node)));
            high = std::max(high, along.dot(x().col(node)));
        }
        require(high > low, "body", "free surface nodes apart from each other", "none");
        Field field = Field::Zero(Dim, x().cols());
        for (int node : m_free_surface_nodes) {
            const Scalar d = (2 * along.dot(x().col(node)) - low - high) / (high - low);
            field.col(node) = -d * std::abs(d) * along;
        }
        return field;
    }

private:
    [[nodiscard]] const Points<Dim, Scalar>& x() const { return m_body->rest_positions; }
    [[nodiscard]] Point centre() const { return (m_low + m_high) / 2; }

    [[nodiscard]] static Scalar part(std::mt19937& random) {
        return std::uniform_real_distribution<Scalar>(0, 1)(random);
    }

    /// A direction, within the plane of the body where it is a flat sheet.
    [[nodiscard]] Point direction(std::mt19937& random) const {
        std::normal_distribution<Scalar> normal;
        Point result;
        do {
            for (int d = 0; d < Dim; ++d) {
                result(d) = normal(random);
            }
            if constexpr (Dim == 3) {
                if (m_is_flat) {
                    result -= m_normal.dot(result) * m_normal;
                }
            }
        } while (!(result.norm() > Scalar(1e-3)));
        return result.normalized();
    }

    /// A point of the bounding box.
    [[nodiscard]] Point point(std::mt19937& random) const {
        Point result;
        for (int d = 0; d < Dim; ++d) {
            result(d) = m_low(d) + part(random) * (m_high(d) - m_low(d));
        }
        return result;
    }

    [[nodiscard]] int nearest(const Point& at) const {
        return *std::min_element(m_free_surface_nodes.begin(), m_free_surface_nodes.end(), [&](int a, int b) {
            return (x().col(a) - at).squaredNorm() < (x().col(b) - at).squaredNorm();
        });
    }

    /// Of a patch, 10 to 20 % of the body's size.
    [[nodiscard]] Scalar radius(std::mt19937& random) const { return (1 + part(random)) * m_size / 10; }

    /// The distance from a surface node to the second ring or so of its neighbours on the surface: a mesh does not
    /// resolve the answer to loads that change faster.
    [[nodiscard]] Scalar least_radius(const Point& middle) const {
        const std::size_t n_neighbours = Dim == 2 ? 5 : 20;
        std::vector<Scalar> distances;
        for (int node : m_free_surface_nodes) {
            distances.push_back((x().col(node) - middle).norm());
        }
        const std::size_t last = std::min(n_neighbours, distances.size() - 1);
        std::nth_element(distances.begin(), distances.begin() + static_cast<std::ptrdiff_t>(last), distances.end());
        return distances[last];
    }

    /// Falls from 1 in the middle of a patch to 0 at its radius.
    [[nodiscard]] Scalar weight(int node, const Point& middle, Scalar radius) const {
        const Scalar distance = (x().col(node) - middle).norm() / radius;
        return std::max(Scalar(0), 1 - distance * distance);
    }

    /// From 0 at the free nodes next to the clamp to 1 at those farthest away: (1 - w) s + w s^2.
    [[nodiscard]] Scalar profile(Index node, Scalar square) const {
        const Scalar s = std::clamp((m_away.dot(x().col(node)) - m_start) / m_length, Scalar(0), Scalar(1));
        return (1 - square) * s + square * s * s;
    }

    [[nodiscard]] Field growing(std::mt19937& random, const Point& along) const {
        const Scalar square = part(random);
        Field field(Dim, x().cols());
        for (Index i = 0; i < field.cols(); ++i) {
            field.col(i) = profile(i, square) * along;
        }
        return field;
    }

    void take_directions(const std::vector<int>& clamped) {
        const Point mean = x().rowwise().mean();
        const Points<Dim, Scalar> arms = x().colwise() - mean;
        const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<Scalar, Dim, Dim>> directions(
            arms * arms.transpose() / static_cast<Scalar>(x().cols()));
        if constexpr (Dim == 3) {
            const auto& spread = directions.eigenvalues();
            const Scalar none = 100 * std::numeric_limits<Scalar>::epsilon() * m_size * m_size;
            m_is_flat = spread(0) <= none && spread(1) > none;
            m_normal = directions.eigenvectors().col(0);
        }
        m_away.setZero();
        if (!clamped.empty()) {
            m_away = mean - x()(Eigen::all, clamped).rowwise().mean();
        }
        if (!(m_away.norm() > Scalar(1e-3) * m_size)) { // held all around, or not at all: the longest direction
            m_away = directions.eigenvectors().col(Dim - 1);
            Index largest = 0;
            m_away.cwiseAbs().maxCoeff(&largest);
            m_away *= m_away(largest) < 0 ? -1 : 1;
        }
        m_away.normalize();
        m_start = std::numeric_limits<Scalar>::max();
        Scalar end = std::numeric_limits<Scalar>::lowest();
        for (Index i = 0; i < x().cols(); ++i) {
            if (!is_held(i)) {
                m_start = std::min(m_start, m_away.dot(x().col(i)));
                end = std::max(end, m_away.dot(x().col(i)));
            }
        }
        m_length = end - m_start;
        if (!(m_length > Scalar(1e-6) * m_size)) { // one layer of free nodes: all at the far end
            m_length = m_size;
            m_start = end - m_length;
        }
    }

    const Specimen<Dim, Scalar>* m_body;
    std::vector<bool> m_is_held;
    std::vector<int> m_free_surface_nodes;
    Point m_low;
    Point m_high;
    Scalar m_size = 0;
    bool m_is_flat = false;
    Vector<3, Scalar> m_normal = Vector<3, Scalar>::UnitZ(); ///< of a flat sheet
    Point m_away;                                            ///< unit vector from the clamp into the body
    Scalar m_start = 0;                                      ///< of the free nodes along it
    Scalar m_length = 0;
};

} // namespace springfit::detail
