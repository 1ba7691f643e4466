% The modal two-point scheme of van Walstijn, Bridges & Mehes 2016 (eqs 33, 38-52):
% octave-cli two_point.m problem.json trace.csv
% One contact of exponent 1 at most, and a thread. In MATLAB, set the two names in the next line.
if exist('OCTAVE_VERSION'), files = argv(); else, files = {'problem.json', 'trace.csv'}; end
if strcmp(files{1}, 'represents')  % as `jvari check` asks
  disp(['represents: bending stiffness, damping, frequency-dependent damping, measured modes, ' ...
        'lumped barrier, thread, initial shape, pluck']);
  disp('balance: exact');
  exit(0);
end
p = jsondecode(fileread(files{1}));
if p.contacts > 1 || any(p.contact_exponent != 1) || any(p.contact_loss != 0)
  disp('this scheme takes one contact at most, of exponent 1 and without loss');
  exit(3);  % refused
end
dt = 1/p.sample_rate; steps = p.steps_per_row; none = zeros(p.modes, 1);
omega = sqrt(p.omega0.^2 - p.sigma.^2); R = exp(-p.sigma*dt); E = expm1(-p.sigma*dt);
num = real(E.^2 + 4*R.*sin(omega*dt/2).^2); den = real(E.^2 + 4*R.*cos(omega*dt/2).^2);
a = num./den; b = -2*expm1(-2*p.sigma*dt)./den;                                          % (33)
J = 1 + a + b; xi = dt^2/(2*p.modal_mass);
g_b = none; g_c = none; g_e = none; k_b = 0; h_b = 0;
if p.contacts
  g_b = p.contact_weights(1, :)'; k_b = p.contact_stiffness; h_b = p.contact_height;
end
if p.threads, g_c = p.thread_weights(:); end
if p.plucks, g_e = p.pluck_weights(:); end
e_b = xi./J.*g_b; e_c = xi./J.*g_c; e_e = xi./J.*g_e;
k_c = p.thread_stiffness; h_c = p.thread_height; phi_c = k_c/2 + p.thread_damping/dt;
inverse_c = 1/(1 + phi_c*(g_c'*e_c)); theta_bc = g_b'*e_c;
beta_c = phi_c*theta_bc*inverse_c;                                                       % (47)
theta = g_b'*e_b - beta_c*theta_bc; phi = theta*k_b/2;
pluck = zeros((p.rows - 1)*steps + 2, 1); pluck(1:numel(p.pluck_force)) = p.pluck_force;
is = @(quantity) double(strcmp(p.tap_quantities, quantity));
reads = is('displacement') + is('nut_force'); moves = is('velocity');
y = p.start; q = none; n = 0; trace = zeros(p.rows, p.taps); F_b = 0; sum_b = 0; sum_c = 0;
energy = zeros(p.rows, 3); supplied = 0; lost = 0;                        % (49), (51), (52) [J]
for row = 1:p.rows
  trace(row, :) = reads.*(p.tap_weights*y) + moves.*(p.tap_weights*(2/dt*q)) ...
                  + (is('bridge_force')*sum_b + is('thread_force')*sum_c ...
                     - is('driving_force')*(sum_b + sum_c))/steps;
  energy(row, :) = [sum(q.^2 + a.*y.^2)/xi + k_b/2*max(0, h_b - g_b'*y)^2 ...
                    + p.threads*k_c/2*(h_c - g_c'*y)^2, supplied, lost];
  sum_b = 0; sum_c = 0; supplied = 0; lost = 0;
  for step = 1:steps
    n = min(n + 1, numel(pluck) - 1);
    F_e = (pluck(n) + pluck(n + 1))/2; u = 2./J.*(q - a.*y) + e_e*F_e;                   % (42)
    v_c = (k_c*(h_c - g_c'*y) - phi_c*(g_c'*u))*inverse_c;
    d = h_b - g_b'*y; B = -(g_b'*u) - theta_bc*v_c;    % r + B = theta F: (48), the cases of fig 4
    if k_b == 0 || (d <= 0 && d + B <= 0), F_b = 0;
    elseif d > 0 && d*(1 - phi) + B > 0, F_b = ((2*phi*d - B)/(1 + phi) + B)/theta;
    elseif d > 0, F_b = ((-B + sqrt(B^2 + 4*phi*d^2))/2 + B)/theta;
    else, F_b = (-(B - 2*phi*d + sqrt(B^2 - 4*phi*d*(B + d)))/(2*(1 + phi)) + B)/theta; end
    F_c = v_c - beta_c*F_b;                                                              % (46)
    s = u + e_b*F_b + e_c*F_c; y = y + s; q = s - q;                                 % (40), (41)
    sum_b = sum_b + F_b; sum_c = sum_c + F_c; supplied = supplied + F_e*(g_e'*s);
    lost = lost + sum(b.*s.^2)/xi + p.thread_damping/dt*(g_c'*s)^2;
  end
end
file = fopen(files{2}, 'w');
fprintf(file, 'time_s'); fprintf(file, ',%s', p.tap_names{:});
fprintf(file, ',energy_stored_J,energy_supplied_J,energy_dissipated_J\n');
rows = [(0:p.rows - 1)'/p.tap_rate, trace, energy];
fprintf(file, ['%.17g' repmat(',%.17g', 1, p.taps + 3) '\n'], rows');
fclose(file);
