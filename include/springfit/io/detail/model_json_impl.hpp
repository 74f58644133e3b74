// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>
#include <limits>

#include <springfit/io/model_json.hpp>

namespace springfit::io {

namespace detail {

inline constexpr std::string_view model_format = "springfit-model";
inline constexpr int model_version = 1;

/// The JSON pointer of the first number that is not finite; empty where there is none.
[[nodiscard]] inline std::string first_not_finite(const Json& value, const std::string& pointer = {}) {
    if (value.is_number_float()) {
        return std::isfinite(value.get<double>()) ? std::string{} : pointer;
    }
    if (value.is_structured()) {
        for (const auto& [key, member] : value.items()) {
            if (auto found = first_not_finite(member, pointer + "/" + key); !found.empty()) {
                return found;
            }
        }
    }
    return {};
}

/// Rows of JSON numbers, one per column of the matrix.
template <class Matrix>
[[nodiscard]] Json columns_to_json(const Matrix& matrix) {
    Json result = Json::array();
    for (Index c = 0; c < matrix.cols(); ++c) {
        Json column = Json::array();
        for (Index r = 0; r < matrix.rows(); ++r) {
            if constexpr (std::floating_point<typename Matrix::Scalar>) {
                column.push_back(static_cast<double>(matrix(r, c)));
            } else {
                column.push_back(matrix(r, c));
            }
        }
        result.push_back(std::move(column));
    }
    return result;
}

template <std::floating_point Scalar>
[[nodiscard]] Json values_to_json(const Values<Scalar>& values) {
    Json result = Json::array();
    for (Index i = 0; i < values.size(); ++i) {
        result.push_back(static_cast<double>(values(i)));
    }
    return result;
}

enum class Range { any, not_negative, positive };

template <std::floating_point Scalar>
[[nodiscard]] Scalar read_number(const JsonPlace& place, Range range) {
    const auto value = static_cast<Scalar>(place.number());
    const bool in_range = range == Range::any || (range == Range::positive ? value > 0 : value >= 0);
    if (!(in_range && std::isfinite(value))) {
        place.refuse(range == Range::any        ? "a finite number"
                     : range == Range::positive ? "a positive number"
                                                : "a number not below 0",
                     place.found());
    }
    return value;
}

template <std::floating_point Scalar>
[[nodiscard]] Values<Scalar> read_values(const JsonPlace& place, Index size, std::string_view owner, Range range) {
    (void)place.array_size(text("an array of ", size, ", one number per ", owner), size);
    Values<Scalar> values(size);
    for (Index i = 0; i < size; ++i) {
        values(i) = read_number<Scalar>(place.element(static_cast<std::size_t>(i)), range);
    }
    return values;
}

template <int Dim, std::floating_point Scalar>
[[nodiscard]] Points<Dim, Scalar> read_positions(const JsonPlace& place, std::string_view owner) {
    const auto n = static_cast<Index>(place.array_size(text("an array, one position per ", owner)));
    if (n == 0 || n > std::numeric_limits<int>::max()) {
        place.refuse(text("an array, one position per ", owner, ", at least one"), place.found());
    }
    Points<Dim, Scalar> positions(Dim, n);
    for (Index i = 0; i < n; ++i) {
        const JsonPlace position = place.element(static_cast<std::size_t>(i));
        (void)position.array_size(text("an array of ", Dim, ", the coordinates"), Dim);
        for (int d = 0; d < Dim; ++d) {
            positions(d, i) = read_number<Scalar>(position.element(static_cast<std::size_t>(d)), Range::any);
        }
    }
    return positions;
}

inline void check_model_header(const Json& json, const std::string& file) {
    const JsonPlace root(json, file);
    const auto expect_text = [&](std::string_view key, std::string_view expected) {
        const JsonPlace place = root.member(key);
        if (place.string() != expected) {
            place.refuse(text('"', expected, '"'), place.found());
        }
    };
    expect_text("format", model_format);
    const JsonPlace version = root.member("version");
    if (version.value() != model_version) {
        version.refuse(text(model_version), version.found());
    }
    expect_text("units", "SI");
    expect_text("damping_law", "axial");
}

template <int Dim, std::floating_point Scalar>
[[nodiscard]] SpringNetwork<Dim, Scalar> read_network(const JsonPlace& nodes, const JsonPlace& springs) {
    SpringNetwork<Dim, Scalar> network;
    network.rest_positions = read_positions<Dim, Scalar>(nodes.member("rest_position"), "node");
    const Index n_nodes = network.n_nodes();
    network.mass = read_values<Scalar>(nodes.member("mass"), n_nodes, "node", Range::positive);

    const JsonPlace ends = springs.member("nodes");
    const auto n_springs = static_cast<Index>(ends.array_size("an array, one pair of nodes per spring"));
    network.springs.resize(2, n_springs);
    for (Index e = 0; e < n_springs; ++e) {
        const JsonPlace pair = ends.element(static_cast<std::size_t>(e));
        (void)pair.array_size("an array of 2, the ends of the spring", 2);
        for (int end = 0; end < 2; ++end) {
            network.springs(end, e) = pair.element(static_cast<std::size_t>(end)).index_below(n_nodes);
        }
        if (network.springs(0, e) == network.springs(1, e)) {
            pair.refuse("two different nodes", pair.value().dump());
        }
    }
    const auto per_spring = [&](std::string_view key, Range range) {
        return read_values<Scalar>(springs.member(key), n_springs, "spring", range);
    };
    network.stiffness = per_spring("stiffness", Range::not_negative);
    network.rest_length = per_spring("rest_length", Range::positive);
    network.damping = per_spring("damping", Range::not_negative);
    return network;
}

template <int Dim, std::floating_point Scalar>
void read_cells(const JsonPlace& cells, SpringNetwork<Dim, Scalar>& network) {
    const JsonPlace corners = cells.member("nodes");
    const auto n_cells = static_cast<Index>(corners.array_size("an array, the corners of each cell"));
    network.cells.resize(Dim + 1, n_cells);
    for (Index c = 0; c < n_cells; ++c) {
        const JsonPlace cell = corners.element(static_cast<std::size_t>(c));
        (void)cell.array_size(text("an array of ", Dim + 1, ", the corners of the cell"), Dim + 1);
        SimplexCorners<Dim, Scalar> positions;
        for (int a = 0; a <= Dim; ++a) {
            const int node = cell.element(static_cast<std::size_t>(a)).index_below(network.n_nodes());
            network.cells(a, c) = node;
            positions.col(a) = network.rest_positions.col(node);
        }
        if (!(signed_volume<Dim, Scalar>(positions) > 0)) {
            cell.refuse("different corners in positive order around a positive volume at rest", cell.value().dump());
        }
    }
    network.rest_volume = read_values<Scalar>(cells.member("rest_volume"), n_cells, "cell", Range::positive);
    network.volume_stiffness = read_values<Scalar>(cells.member("stiffness"), n_cells, "cell", Range::any);
}

/// The surface with the nodes and weights of each of its points.
template <int Dim, std::floating_point Scalar>
[[nodiscard]] Json surface_to_json(const EmbeddedSurface<Dim, Scalar>& surface) {
    Json json;
    json["rest_position"] = columns_to_json(surface.rest_positions);
    json["cells"] = columns_to_json(surface.cells);
    Json& nodes = json["nodes"] = Json::array();
    Json& weights = json["weights"] = Json::array();
    for (Index p = 0; p < surface.n_points(); ++p) {
        Json point_nodes = Json::array();
        Json point_weights = Json::array();
        for (typename SparseMatrix<Scalar>::InnerIterator weight(surface.from_nodes.weights, p); weight; ++weight) {
            point_nodes.push_back(weight.row());
            point_weights.push_back(static_cast<double>(weight.value()));
        }
        nodes.push_back(std::move(point_nodes));
        weights.push_back(std::move(point_weights));
    }
    return json;
}

template <int Dim, std::floating_point Scalar>
[[nodiscard]] EmbeddedSurface<Dim, Scalar> read_surface(const JsonPlace& place, Index n_nodes) {
    EmbeddedSurface<Dim, Scalar> surface;
    surface.rest_positions = read_positions<Dim, Scalar>(place.member("rest_position"), "point");
    const Index n_points = surface.n_points();

    const JsonPlace cells = place.member("cells");
    surface.cells.resize(Dim, static_cast<Index>(cells.array_size("an array, the corners of each cell")));
    for (Index c = 0; c < surface.n_cells(); ++c) {
        const JsonPlace cell = cells.element(static_cast<std::size_t>(c));
        (void)cell.array_size(text("an array of ", Dim, ", the corners of the cell"), Dim);
        for (int a = 0; a < Dim; ++a) {
            surface.cells(a, c) = cell.element(static_cast<std::size_t>(a)).index_below(n_points);
        }
    }

    const JsonPlace nodes = place.member("nodes");
    const JsonPlace weights = place.member("weights");
    (void)nodes.array_size(text("an array of ", n_points, ", the nodes that carry each point"), n_points);
    (void)weights.array_size(text("an array of ", n_points, ", the weights of each point"), n_points);
    std::vector<Eigen::Triplet<Scalar>> entries;
    for (Index p = 0; p < n_points; ++p) {
        const JsonPlace point_nodes = nodes.element(static_cast<std::size_t>(p));
        const JsonPlace point_weights = weights.element(static_cast<std::size_t>(p));
        const std::size_t n_weights = point_nodes.array_size("an array of node numbers");
        (void)point_weights.array_size(text("an array of ", n_weights, ", one weight per node"),
                                       static_cast<std::ptrdiff_t>(n_weights));
        Scalar sum = 0;
        for (std::size_t w = 0; w < n_weights; ++w) {
            const auto weight = read_number<Scalar>(point_weights.element(w), Range::any);
            entries.emplace_back(point_nodes.element(w).index_below(n_nodes), static_cast<int>(p), weight);
            sum += weight;
        }
        if (!(std::abs(sum - 1) <= 1000 * std::numeric_limits<Scalar>::epsilon())) {
            point_weights.refuse("weights that sum to 1", text("a sum of ", sum));
        }
    }
    surface.from_nodes.weights.resize(n_nodes, n_points);
    surface.from_nodes.weights.setFromTriplets(entries.begin(), entries.end());
    return surface;
}

} // namespace detail

template <int Dim, std::floating_point Scalar>
std::string model_text(const Model<Dim, Scalar>& model) {
    const auto& network = model.network;
    validate(network);
    require(model.stable_time_step > 0 && std::isfinite(model.stable_time_step), "stable_time_step",
            "a positive time step", model.stable_time_step);
    for (std::size_t a = 0; a < model.fixed.size(); ++a) {
        require(model.fixed[a] >= 0 && model.fixed[a] < network.n_nodes() &&
                    (a == 0 || model.fixed[a] > model.fixed[a - 1]),
                "fixed", text("ascending node numbers in [0, ", network.n_nodes(), ")"), model.fixed[a]);
    }
    require(model.provenance.is_object(), "provenance", "a JSON object", model.provenance.type_name());
    const std::string not_finite = detail::first_not_finite(model.provenance);
    require(not_finite.empty(), "provenance", "finite numbers", text("a value that is not finite at ", not_finite));

    Json json;
    json["format"] = detail::model_format;
    json["version"] = detail::model_version;
    json["dimension"] = Dim;
    json["units"] = "SI";
    json["damping_law"] = "axial";
    json["nodes"]["rest_position"] = detail::columns_to_json(network.rest_positions);
    json["nodes"]["mass"] = detail::values_to_json(network.mass);
    json["nodes"]["fixed"] = model.fixed;
    json["springs"]["nodes"] = detail::columns_to_json(network.springs);
    json["springs"]["stiffness"] = detail::values_to_json(network.stiffness);
    json["springs"]["rest_length"] = detail::values_to_json(network.rest_length);
    json["springs"]["damping"] = detail::values_to_json(network.damping);
    if (model.data_share.size() > 0) {
        require(model.data_share.size() == network.n_springs() && model.data_share.minCoeff() >= 0, "data_share",
                text(network.n_springs(), " parts in [0, 1], one per spring"), model.data_share.size());
        json["springs"]["data_share"] = detail::values_to_json(model.data_share);
    }
    if (network.n_cells() > 0) {
        json["cells"]["nodes"] = detail::columns_to_json(network.cells);
        json["cells"]["rest_volume"] = detail::values_to_json(network.rest_volume);
        json["cells"]["stiffness"] = detail::values_to_json(network.volume_stiffness);
    }
    if (model.surface) {
        validate(*model.surface, network.n_nodes());
        json["surface"] = detail::surface_to_json(*model.surface);
    }
    json["stable_time_step"] = static_cast<double>(model.stable_time_step);
    json["provenance"] = model.provenance;
    return json_text(json);
}

inline int model_dimension(const Json& json, const std::string& file) {
    detail::check_model_header(json, file);
    const JsonPlace dimension = JsonPlace(json, file).member("dimension");
    if (dimension.value() != 2 && dimension.value() != 3) {
        dimension.refuse("2 or 3", dimension.found());
    }
    return dimension.value().get<int>();
}

template <int Dim, std::floating_point Scalar>
Model<Dim, Scalar> model_from_json(const Json& json, const std::string& file) {
    const JsonPlace root(json, file);
    if (const int dimension = model_dimension(json, file); dimension != Dim) {
        root.member("dimension").refuse(text(Dim), text(dimension));
    }
    Model<Dim, Scalar> model;
    const JsonPlace nodes = root.member("nodes");
    model.network = detail::read_network<Dim, Scalar>(nodes, root.member("springs"));
    if (root.member("springs").value().contains("data_share")) {
        model.data_share =
            detail::read_values<Scalar>(root.member("springs").member("data_share"), model.network.n_springs(),
                                        "spring", detail::Range::not_negative);
    }
    if (json.contains("cells")) {
        detail::read_cells<Dim, Scalar>(root.member("cells"), model.network);
    }
    if (json.contains("surface")) {
        model.surface = detail::read_surface<Dim, Scalar>(root.member("surface"), model.network.n_nodes());
    }
    const JsonPlace fixed = nodes.member("fixed");
    for (std::size_t a = 0; a < fixed.array_size("an array of node numbers"); ++a) {
        const JsonPlace place = fixed.element(a);
        model.fixed.push_back(place.index_below(model.network.n_nodes()));
        if (a > 0 && !(model.fixed[a] > model.fixed[a - 1])) {
            place.refuse(text("a node number above ", model.fixed[a - 1]), place.found());
        }
    }
    model.stable_time_step = detail::read_number<Scalar>(root.member("stable_time_step"), detail::Range::positive);
    const JsonPlace provenance = root.member("provenance");
    if (!provenance.value().is_object()) {
        provenance.refuse("an object", provenance.found());
    }
    model.provenance = provenance.value();
    return model;
}

} // namespace springfit::io
