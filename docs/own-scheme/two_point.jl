# The modal two-point scheme of van Walstijn, Bridges & Mehes 2016 (eqs 33, 38-48):
# julia two_point.jl problem.json trace.csv
# One contact of exponent 1 at most, and a thread. The problem has a member a line, so no JSON
# library is needed.
using LinearAlgebra
members = (match(r"^\"(\w+)\": (.*?),?$", line) for line in eachline(ARGS[1]))
texts = ("name", "scene", "reference", "format", "program")
p = Dict(m[1] => eval(Meta.parse(m[2])) for m in members if !isnothing(m) && !(m[1] in texts))
get1(key, default) = isempty(p[key]) ? default : p[key][1]

function contact(d, b, theta, k)  # F of r + b = theta F (48): the four cases of fig 4
    phi = theta * k / 2
    (k == 0 || (d <= 0 && d + b <= 0)) && return 0.0
    r = d > 0 && d * (1 - phi) + b > 0 ? (2phi * d - b) / (1 + phi) :
        d > 0 ? (-b + sqrt(b^2 + 4phi * d^2)) / 2 :
        -(b - 2phi * d + sqrt(b^2 - 4phi * d * (b + d))) / (2 * (1 + phi))
    (r + b) / theta
end

function run(p)
    if p["contacts"] > 1 || any(p["contact_exponent"] .!= 1) || any(p["contact_loss"] .!= 0)
        println("this scheme takes one contact at most, of exponent 1 and without loss")
        exit(3)  # refused
    end
    dt, M, steps, rows = 1 / p["sample_rate"], p["modes"], p["steps_per_row"], p["rows"]
    omega0, sigma = float(p["omega0"]), float(p["sigma"])
    omega, R, E = sqrt.(complex(omega0 .^ 2 - sigma .^ 2)), exp.(-sigma * dt), expm1.(-sigma * dt)
    num, den = (real(E .^ 2 + 4R .* f.(omega * dt / 2) .^ 2) for f in (sin, cos))
    a, b = num ./ den, -2 * expm1.(-2sigma * dt) ./ den  # (33)
    J, xi, none = 1 .+ a + b, dt^2 / (2 * p["modal_mass"]), zeros(M)
    g_b = float(get1("contact_weights", none))
    weights(key) = isempty(p[key]) ? none : float(p[key])
    g_c, g_e = weights("thread_weights"), weights("pluck_weights")
    e_b, e_c, e_e = (xi ./ J .* g for g in (g_b, g_c, g_e))
    k_b, h_b = get1("contact_stiffness", 0.0), get1("contact_height", 0.0)
    k_c, h_c = p["thread_stiffness"], p["thread_height"]
    phi_c = k_c / 2 + p["thread_damping"] / dt
    inverse_c, theta_bc = 1 / (1 + phi_c * dot(g_c, e_c)), dot(g_b, e_c)
    beta_c = phi_c * theta_bc * inverse_c  # (47)
    theta = dot(g_b, e_b) - beta_c * theta_bc
    pluck(n) = n < length(p["pluck_force"]) ? p["pluck_force"][n+1] : 0.0
    y, q, trace, sum_b, sum_c = float(p["start"]), none, zeros(rows, p["taps"]), 0.0, 0.0
    for row in 1:rows
        for (k, quantity) in enumerate(p["tap_quantities"])
            trace[row, k] = quantity == "bridge_force" ? sum_b / steps :
                            quantity == "thread_force" ? sum_c / steps :
                            quantity == "driving_force" ? -(sum_b + sum_c) / steps :
                            dot(p["tap_weights"][k], quantity == "velocity" ? 2 / dt * q : y)
        end
        sum_b = sum_c = 0.0
        for n in (row-1)*steps:row*steps-1
            u = 2 ./ J .* (q - a .* y) + e_e * (pluck(n) + pluck(n + 1)) / 2  # (42)
            v_c = (k_c * (h_c - dot(g_c, y)) - phi_c * dot(g_c, u)) * inverse_c
            F_b = contact(h_b - dot(g_b, y), -dot(g_b, u) - theta_bc * v_c, theta, k_b)
            F_c = v_c - beta_c * F_b  # (46)
            s = u + e_b * F_b + e_c * F_c  # (41)
            y, q, sum_b, sum_c = y + s, s - q, sum_b + F_b, sum_c + F_c  # (40)
        end
    end
    trace
end

trace = run(p)
open(ARGS[2], "w") do file
    println(file, join(["time_s"; p["tap_names"]], ","))
    foreach(n -> println(file, join([(n - 1) / p["tap_rate"]; trace[n, :]], ",")), axes(trace, 1))
end
