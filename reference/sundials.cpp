// Wraps CVODE behind integrator.hpp and does the work for its events. No other file includes
// SUNDIALS (6.4).
#include <cvode/cvode.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <type_traits>

#include "reference/integrator.hpp"

namespace jvari {

static_assert(std::is_same_v<realtype, double>, "SUNDIALS in double precision");

namespace {
constexpr double unweighted = 1e-30;  // error weight for uncontrolled components
// number of splits in one go, for steps that might have touched or left and come back
constexpr int most_splits = 40;

// Finds the greatest value of a quantity known at step ends. At a turning point the value comes
// from the parabola through the last three.
class Peak {
public:
    double most = -HUGE_VAL;

    void forget() noexcept { known_ = 0; }  // the next values do not continue the previous ones
    void next(double t, double x) noexcept {
        most = std::max(most, x);
        if (known_ == 2 && x_[1] > 0 && x_[1] >= x_[0] && x_[1] >= x) {
            const double slope = (x - x_[1]) / (t - t_[1]), room = t_[1] - t_[0],
                         bend = ((x_[1] - x_[0]) / room - slope) / (t - t_[0]);
            const double now = slope + bend * (t - t_[1]);  // at t_[1]
            if (bend > 0) most = std::max(most, x_[1] + 0.25 * now * now / bend);
        }
        if (known_ == 2) t_[0] = t_[1], x_[0] = x_[1], known_ = 1;
        t_[known_] = t, x_[known_] = x;
        ++known_;
    }

private:
    double t_[2], x_[2];
    int known_ = 0;
};
}  // namespace

struct Integrator::Library {
    Library(Equations& e, const Settings& s) : equations(e), settings(s) {
        const int size = e.size();
        const auto need = [](bool ok) {
            if (!ok) throw std::bad_alloc();
        };
        need(SUNContext_Create(nullptr, &context) == 0);
        need((z = N_VNew_Serial(size, context)) != nullptr);
        N_VConst(0, z);
        before.assign(size, 0.0);
        dz.assign(size, 0.0);
        found.assign(e.contacts + 1, 0);
        direction.assign(e.contacts + 1, 0);
        depth.assign(e.contacts + 1, {});
        met.resize(e.contacts);
        depth_before = depth;
        need((solver = SUNLinSolNewEmpty(context)) != nullptr);
        solver->ops->gettype = type;
        solver->ops->solve = solve;
        solver->content = this;
        need((memory = CVodeCreate(s.method == Method::bdf ? CV_BDF : CV_ADAMS, context)) !=
             nullptr);
        need(CVodeInit(memory, slope, 0, z) == CV_SUCCESS &&
             CVodeSetUserData(memory, this) == CV_SUCCESS);
        need(CVodeSetErrHandlerFn(memory, quiet, nullptr) == CV_SUCCESS &&
             CVodeWFtolerances(memory, weights) == CV_SUCCESS);
        need(CVodeSetLinearSolver(memory, solver, nullptr) == CV_SUCCESS);
        if (e.contacts > 0) need(CVodeRootInit(memory, e.contacts, penetrations) == CV_SUCCESS);
        need(begin());
    }
    ~Library() {
        if (memory) CVodeFree(&memory);
        if (solver) solver->content = nullptr;  // this object owns the content
        if (solver) SUNLinSolFree(solver);
        if (z) N_VDestroy(z);
        if (context) SUNContext_Free(&context);
    }
    Library(const Library&) = delete;
    Library& operator=(const Library&) = delete;

    struct Depth {
        double eta, speed;
    };

    double* state() noexcept { return N_VGetArrayPointer(z); }
    // Makes a step from rest, out of contact, so that the library allocates everything here. The
    // library also ignores a root function that starts on its surface until the function has left;
    // this state survives CVodeReInit.
    bool begin() noexcept {
        floor = 1;
        longest_step = 1e-9;
        apart = true;
        N_VConst(0, z);
        const bool stepped = reinit(0) && step(1e-9) >= 0;
        apart = false;
        N_VConst(0, z);
        effort = {};
        std::fill(met.begin(), met.end(), Met{});
        return stepped;
    }
    bool reinit(double t) noexcept {
        time = t;
        return CVodeReInit(memory, t, z) == CV_SUCCESS &&
               CVodeSetMaxStep(memory, longest_step) == CV_SUCCESS &&
               (equations.contacts == 0 ||
                CVodeSetRootDirection(memory, direction.data()) == CV_SUCCESS);
    }
    // Makes one step chosen by the library.
    int step(double to) noexcept {
        ++effort.steps;
        if (CVodeSetStopTime(memory, to) != CV_SUCCESS) return -1;
        return CVode(memory, to, z, &time, CV_ONE_STEP);
    }
    void look(std::vector<Depth>& at) noexcept {
        for (int a = 0; a < equations.contacts; ++a)
            at[a] = {equations.penetration(a, state()), equations.penetration_speed(a, state())};
    }
    double last_step() const noexcept {
        double h = 0;
        CVodeGetLastStep(memory, &h);
        return h;
    }
    // Time in the last step at which a barrier's surface may have been crossed twice; -1 if
    // impossible. A convex penetration stays on its side between its turning point's two tangents,
    // provided that their intersection does.
    double turns_beyond() const noexcept {
        for (int a = 0; a < equations.contacts; ++a) {
            const double side = equations.touched[a] ? 1 : -1, h = time - time_before;
            const Depth from{side * depth_before[a].eta, side * depth_before[a].speed},
                to{side * depth[a].eta, side * depth[a].speed};
            if (!(from.speed < 0 && to.speed > 0)) continue;
            const double since = (to.eta - from.eta - to.speed * h) / (from.speed - to.speed);
            if (from.eta + from.speed * since < 0 && since > 0.01 * h && since < 0.99 * h)
                return time_before + since;
        }
        return -1;
    }
    // the crossing at `time`, no later than `to`
    void onto_surface(double to) noexcept {
        const double speed = equations.penetration_speed(contact, state());
        const double room = time - time_before;
        if (speed == 0) return;
        const double shift = std::clamp(-equations.penetration(contact, state()) / speed,
                                        -0.5 * room, std::min(0.5 * room, to - time));
        equations.slope(time, state(), dz.data());
        for (int i = 0; i < equations.size(); ++i) state()[i] += shift * dz[i];
        time += shift;
    }

    static int slope(realtype t, N_Vector z, N_Vector dz, void* user) {
        auto& l = *static_cast<Library*>(user);
        ++l.effort.slopes;
        l.equations.slope(t, N_VGetArrayPointer(z), N_VGetArrayPointer(dz));
        return 0;
    }
    static int penetrations(realtype, N_Vector z, realtype* out, void* user) {
        auto& l = *static_cast<Library*>(user);
        for (int a = 0; a < l.equations.contacts; ++a)
            out[a] = l.apart ? -1 : l.equations.penetration(a, N_VGetArrayPointer(z));
        return 0;
    }
    static int weights(N_Vector z, N_Vector w, void* user) {
        auto& l = *static_cast<Library*>(user);
        const double* x = N_VGetArrayPointer(z);
        double* weight = N_VGetArrayPointer(w);
        const int controlled = 2 * l.equations.padded;
        for (int i = 0; i < controlled; ++i)
            weight[i] = 1 / (l.settings.tolerance * (std::abs(x[i]) + l.floor));
        std::fill(weight + controlled, weight + l.equations.size(), unweighted);
        return 0;
    }
    static SUNLinearSolver_Type type(SUNLinearSolver) { return SUNLINEARSOLVER_MATRIX_EMBEDDED; }
    // A matrix-free direct solver: the Newton matrix I - gamma J at the iterate itself, so Newton's
    // own order of convergence holds.
    static int solve(SUNLinearSolver s, SUNMatrix, N_Vector x, N_Vector b, realtype) {
        auto& l = *static_cast<Library*>(s->content);
        double t = 0, gamma = 0, rl1 = 0;
        N_Vector predicted = nullptr, current = nullptr, f = nullptr, other = nullptr;
        void* user = nullptr;
        if (const int failed = CVodeGetNonlinearSystemData(l.memory, &t, &predicted, &current, &f,
                                                           &gamma, &rl1, &other, &user))
            return failed;
        ++l.effort.solves;
        l.equations.solve(t, gamma, N_VGetArrayPointer(current), N_VGetArrayPointer(b),
                          N_VGetArrayPointer(x));
        return 0;
    }
    static void quiet(int, const char*, const char*, char*, void*) {}

    Equations& equations;
    const Settings settings;
    SUNContext context = nullptr;
    N_Vector z = nullptr;
    SUNLinearSolver solver = nullptr;
    void* memory = nullptr;
    double time = 0, longest_step = 0, floor = 0;
    double time_before = 0;
    std::vector<double> before, dz;  // the state one step ago; a slope
    int contact = -1;
    bool apart = false;  // whatever the state
    std::vector<Depth> depth, depth_before;
    std::vector<int> found, direction;
    struct Effort {
        double steps = 0, slopes = 0, solves = 0;
    } effort;
    struct Met {
        Peak depth, push, pull;  // [m], [N], [N]
    };
    std::vector<Met> met;  // [contact]
};

Integrator::Integrator(Equations& e, const Settings& s)
    : library_(std::make_unique<Library>(e, s)) {}
Integrator::~Integrator() = default;
double* Integrator::state() noexcept { return library_->state(); }
double Integrator::time() const noexcept { return library_->time; }
int Integrator::crossed() const noexcept { return library_->contact; }
std::vector<Fact> Integrator::facts(double events, bool solves) const {
    const Library& l = *library_;
    std::vector<Fact> all = {{facts::events, events},
                             {facts::contact_points, double(l.equations.contacts)},
                             {facts::integrator_steps, l.effort.steps},
                             {facts::slope_evaluations, l.effort.slopes}};
    if (solves) all.push_back({facts::linear_solves, l.effort.solves});
    double deepest = 0, push = 0, pull = -HUGE_VAL;
    for (const auto& m : l.met) {
        deepest = std::max(deepest, m.depth.most);
        push = std::max(push, m.push.most);
        pull = std::max(pull, m.pull.most);
    }
    all.insert(all.end(), {{facts::integrator_tolerance, l.settings.tolerance},
                           {facts::smallest_contact_force, pull == -HUGE_VAL ? 0 : -pull},
                           {facts::largest_contact_force, push},
                           {facts::deepest_penetration, deepest}});
    return all;
}
void Integrator::reset() noexcept { library_->begin(); }

void Integrator::restart(double longest_step) noexcept {
    Library& l = *library_;
    l.longest_step = longest_step;
    // The floor counts pressing forces beside motion: a string at rest that a barrier or a thread
    // is about to push has no scale yet. [m/s]
    l.floor =
        std::max({1e-3 * std::sqrt(l.equations.scale_squared(l.state()) / (2 * l.equations.padded)),
                  l.equations.rounding(l.state()) / l.settings.tolerance, 1e-30});
    for (int a = 0; a < l.equations.contacts; ++a) l.direction[a] = l.equations.touched[a] ? -1 : 1;
    for (auto& m : l.met) m.depth.forget(), m.push.forget(), m.pull.forget();
    l.look(l.depth);
    l.contact = l.reinit(0) ? -1 : -2;
}

Integrator::Stop Integrator::advance(double to, const Block& out) noexcept {
    Library& l = *library_;
    if (l.contact == -2) return Stop::failed;
    const int contacts = l.equations.contacts;
    double target = to;
    int splits = 0, crawled = 0;
    // away from the surface
    const auto inward = [&](int a, double speed) {
        return l.equations.touched[a] ? speed > 0 : speed < 0;
    };
    while (l.time < to) {
        // shorter than the library would step
        if (to - l.time <= 8 * std::numeric_limits<double>::epsilon() * to) break;
        std::copy_n(l.state(), l.before.size(), l.before.begin());
        l.time_before = l.time;
        std::swap(l.depth, l.depth_before);
        const int result = l.step(target);
        if (result < 0 || out.stopped()) return Stop::failed;
        // A system this stiff would need 1e12 steps.
        crawled = l.time - l.time_before < 1e-12 * to ? crawled + 1 : 0;
        if (crawled > 10000) return Stop::failed;
        l.contact = -1;
        if (result == CV_ROOT_RETURN) {
            if (CVodeGetRootInfo(l.memory, l.found.data()) != CV_SUCCESS) return Stop::failed;
            for (int a = contacts - 1; a >= 0; --a)
                if (l.found[a]) l.contact = a;
        }
        l.look(l.depth);
        double split = -1;
        const bool crosses = l.contact >= 0;
        if (!crosses) {
            split = l.turns_beyond();
            for (int a = 0; a < contacts; ++a)
                if (l.equations.touched[a] ? l.depth[a].eta < 0 : l.depth[a].eta > 0)
                    l.contact = a;  // no crossing: the contact started on the surface
        }
        // Inwards from the surface and back within one step: root finding mistakes the rounding at
        // the start for the crossing.
        if (l.contact >= 0 &&
            inward(l.contact, (crosses ? l.depth : l.depth_before)[l.contact].speed))
            split = l.time_before + 0.25 * l.last_step();
        if (split > 0 && splits < most_splits) {
            ++splits;
            std::swap(l.depth, l.depth_before);
            std::copy(l.before.begin(), l.before.end(), l.state());
            if (!l.reinit(l.time_before)) return Stop::failed;
            target = std::min(split, to);
            continue;
        }
        if (crosses) {
            l.onto_surface(to);
            return Stop::crossed;
        }
        if (l.contact >= 0) {
            std::copy(l.before.begin(), l.before.end(), l.state());
            l.time = l.time_before;
            return Stop::crossed;
        }
        for (int a = 0; a < contacts; ++a)
            if (l.equations.touched[a]) {
                const double force = l.equations.contact_force(a, l.state());
                l.met[a].depth.next(l.time, l.depth[a].eta);
                l.met[a].push.next(l.time, force);
                l.met[a].pull.next(l.time, -force);
            }
        if (l.time >= target) {
            if (target == to) break;
            target = to;
        }
    }
    l.time = to;
    return Stop::reached;
}

}  // namespace jvari
