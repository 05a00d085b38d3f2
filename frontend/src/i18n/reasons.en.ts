// English for every reason, generated from the classes: `make codegen` writes it.
import type { ReasonTable } from "./reasons";

export const reasonsEn: ReasonTable = {
  quickest_place: [
    "Localized in about {expected_time_s} by way of this place, {gain_s} sooner than by any other of {places} places tried.",
  ],
  longest_lead: [
    "Localized in about {expected_time_s} by way of this place; of {places} places tried it kept its lead over the most simulated flights.",
  ],
  only_place: ["Localized in about {expected_time_s} by way of this place, the only one {among?allowed=allowed|tried=tried}."],
  soonest_together: [
    "By way of this place the {emitters} emitters still looked for are localized after about {mean_time_s} on average, sooner than by any other of {places|place|places} tried.",
  ],
  soonest_for_first: [
    "For {names} first: localized in about {first_time_s} by way of this place, of {places|place|places} tried. {others|other emitter decides|other emitters decide} only between places that are as good for that.",
  ],
  quickest_place_found: [
    "Localized in about {expected_time_s} by way of this place, found by {search?quadrant=quadrant search|sgd=stochastic gradient descent|bfgs=BFGS}.",
  ],
  planned_meanwhile: [
    "Localized in about {expected_time_s} by way of this place, the best of {places|place|places} tried. Planned on the simpler base policy: the table of the dynamic program is still being computed.",
  ],
  most_information: [
    "A bearing from here narrows the belief most{about?estimate=|worst_case= in the worst case}, of {places|place|places} compared.",
  ],
  least_entropy: ["The next bearing is expected to leave {entropy_nat:2} nat, the least of {places|place|places}."],
  beside_ellipse: ["Across the long axis of the belief, {distance?tabulated=on the nearer side|just_outside=just outside its ellipse}."],
  first_of_route: [
    "The first of {places|place|places} {planner?sopt=that would fix the near edge of the belief|tokekar_subset=that together tell most about the estimate|tokekar_tree=that hold out best against unlucky bearings|lookahead=on the course that tells most about the estimate}.",
  ],
  no_bearing_yet: ["No bearing has been taken.", "Take the first bearing."],
  bearings_not_in_belief: [
    "The belief does not contain {bearings|bearing|bearings} yet.",
    "Wait; if it stays so, leave out the last bearing.",
  ],
  too_few_places: [
    "{bearings|bearing|bearings} from {places|place|places}; {needed_places} places are needed.",
    "Take a bearing from another place.",
  ],
  too_few_places_agree: [
    "{agreeing_places} of {places|place|places} {agreeing_places?1=agrees|*=agree} on the estimate; {needed_places} are needed.",
    "Take a bearing from another place.",
  ],
  crossing_angle_too_small: [
    "All bearings come from one side: they cross at only {crossing_deg}; {needed_deg} are needed.",
    "Take a bearing from another side.",
  ],
  estimate_contradicted: [
    "{contradicting} of {bearings|bearing|bearings} {contradicting?1=contradicts|*=contradict} the estimate.",
    "Take another bearing.",
  ],
  bearings_disagree: [
    "The {bearings} bearings contradict each other: at least one is an outlier.",
    "Take another bearing, or exclude the outlier.",
  ],
  bearing_misses_area: ["The bearing points past the search area.", "Check the area, the antenna and the place of the bearing."],
  expected_error_too_large: ["The expected error is {expected_error_m:1}; it must fall below {threshold_m:1}.", "Take another bearing."],
  error_may_be_far_larger: [
    "With {beyond_percent} probability the emitter is more than {far_m} from the estimate, if bearings are wrong altogether or by the same angle; at most {most_percent} is tolerated.",
    "Take another bearing, best from the other side.",
  ],
  no_place_to_fly: ["The vehicle has nowhere to fly: the fence and the no-fly areas leave no room.", "Enlarge the fence."],
  no_place_in_reach: [
    "No place can be reached from here without crossing the fence or a no-fly area.",
    "Change the fence or the no-fly areas, or start elsewhere.",
  ],
  no_way: ["There is no way to the place {distance_m} away without crossing the fence or a no-fly area.", "Choose another place."],
  no_place_sees_belief: [
    "A bearing from any place that is allowed would miss the belief.",
    "Enlarge the fence or lower the standoff distance.",
  ],
  every_place_refused: ["Every place has been refused.", "Hold, or choose the next place yourself."],
  too_many_places: ["Places {spacing_m} apart would be more than {most_places}.", "Space them {finest_m} apart or more."],
  budget_too_small: [
    "A budget of {rollouts|rollout|rollouts} is too small for this search.",
    "Raise it to {needed_rollouts|rollout|rollouts} or more.",
  ],
  fixed_sample_paths: ["This selection needs more sample paths than the {paths} of deterministic sampling.", "Use crn or pmc sampling."],
  belief_out_of_step: ["The belief holds {folded|bearing|bearings}, but {given|was|were} given.", "Fold the bearings given."],
  unusable_area: [
    "The search area {flaw?no_ring=is empty|too_few_corners=has fewer than three corners|not_finite=has a corner whose coordinates are not finite numbers|no_extent=covers no ground: its corners lie on one line or in one point}.",
    "Draw a polygon of at least three corners.",
  ],
  area_crosses_itself: ["The outline of the search area crosses itself near x = {x_m:1}, y = {y_m:1}.", "Untangle it."],
  prior_outside_area: ["The prior has no mass inside the search area.", "Move the prior, or enlarge the area."],
  unusable_gaussian: ["A Gaussian needs a finite mean and a positive definite 2 x 2 covariance."],
  unusable_ring: ["A ring prior needs finite radii, the inner one smaller than the outer one."],
  mean_at_sensor: ["The mean of the belief lies at the sensor, where a bearing has no derivative."],
  unusable_bearing: [
    "A bearing needs {flaw?not_finite=a finite place, angle and sigma|sigma=a positive sigma|outlier_probability=an outlier probability of at least 0 and below 1|peak=a finite angle and a positive weight for each further peak|profile=a finite likelihood in at least eight directions}.",
  ],
  unusable_flights: [
    "A movement time model cannot be fitted: {flaw?lengths_differ=distances, turns and times are not equally many|too_few=fewer than four flights|not_finite=a distance is negative, a time is not positive, or a value is not finite|equal_distances=all flights are equally long, so speed and constant cannot be told apart}.",
  ],
  unusable_number: [
    "{quantity?sigma=The bearing noise sigma|threshold=The threshold of the expected error|measurement_time=The measurement time|speed=The speed of the movement model|turn_rate=The turn rate of the movement model|acceleration=The acceleration of the movement model|movement_constant=The constant of the movement model|action_spacing=The spacing of the action lattice|action_grid=The number of cells of the action grid|platform_position=The position of the platform|actions=The number of actions|budget=The budget in rollouts|horizon=The horizon in bearings|threads=The number of threads|levels=The number of levels|paths=The number of sample paths} must be {wanted?positive=positive and finite|not_negative=finite and not negative|at_least_one=at least one|finite=finite|power_of_two=a power of two}, not {given}.",
  ],
  nearer_than_standoff: [
    "The planner keeps {standoff_m} from the 95 % region; from here it is {clearance_m}. Any nearer, the emitter may be right below, where no bearing fits the antenna's pattern; the forecast does not know that.",
    "The distance is a setting of the mission.",
  ],
  tells_little_of_bias: [
    "The planner compares only places that also show how far the compass is off; this one tells {share_percent} of what the best does, and {wanted_percent} are asked for. The forecast leaves the compass out.",
    "From another side the bearing would tell both.",
  ],
  crosses_too_little: [
    "All that a claim waits for is a bearing from another side: lines must cross at {needed_deg}, and from here they cross at {crossing_deg}. The forecast does not know that.",
    "The angle is a setting of the mission.",
  ],
  echoes_heard_before: [
    "The planner keeps {apart_m} from places where a turn was made; from here it is {away_m}. A bearing so near hears the same echoes again and tells hardly anything new; the forecast does not know that.",
    "Farther from all earlier turns the bearing is a witness of its own.",
  ],
  between_places: [
    "No rule forbids it: the planner compares places {spacing_m} apart with a limited number of simulated flights, and yours is better than what it found.",
  ],
  receiver_misnamed: [
    'The receiver "{device}" {fault?form=is not understood|host=names no host|port=names a port that is not a number from 1 to 65535|driver=names no driver|server=names no server}.',
    "Write {fault?form=soapy:driver=NAME[,key=value], rtl_tcp://HOST[:PORT], sigmf:FILE or recording:FILE|host=rtl_tcp://HOST[:PORT]|port=rtl_tcp://HOST[:PORT]|driver=for instance driver=rtlsdr: a search without a driver would probe the network|server=driver=remote,remote=tcp://HOST:PORT: a search for servers would probe the network}.",
  ],
  receiver_not_open: ["The receiver is not open.", "Open it with its channels first."],
  receiver_silent: ["The receiver has delivered nothing for {quiet_s}.", "Check its cable and driver, and that no other program uses it."],
  nothing_heard_in_turn: ["The receiver delivered nothing during the turn.", "Check that it is running and tuned."],
  receiver_stream_ended: ["The receiver's stream has ended.", "Look at the radio, or play the recording again."],
  receiver_unplugged: ["The receiver was unplugged.", "Plug it in again."],
  samples_lost: [
    "The receiver lost {lost_percent} of its samples.",
    "Check that it is still connected; lower the sample rate if this computer is too slow for it.",
  ],
  nonsensical_power: [
    "The receiver delivers a power of {value} dB, which is impossible; such samples are left out.",
    "Check the receiver and its driver.",
  ],
  recorded_sweep_empty: ["The recorded sweep holds no sample.", "Give another recording."],
  no_channel: ["The receiver was asked for no channel.", "Name at least one emitter with its frequency."],
  frequency_out_of_range: ["The receiver cannot tune to {frequency_hz}.", "Check the emitter's frequency, or use another receiver."],
  frequency_twice: [
    "The receiver was asked for {frequency_hz} twice, and could not tell the two emitters apart.",
    "Look for one of them at a time.",
  ],
  frequency_not_asked_for: ["The receiver delivers samples at {frequency_hz}, which nobody asked for.", "Restart the receiver."],
  carriers_only: ["This receiver measures carriers only, and the tag at {frequency_hz} sends pulses.", "Use a receiver that delivers IQ."],
  one_channel_only: [
    "This receiver hears one emitter at a time, and {asked} were asked for.",
    "Look for one of them at a time, or use a receiver that delivers IQ.",
  ],
  band_too_narrow: [
    "At a sample rate of {sample_rate_hz} the receiver cannot hear {refused_hz} at the same time as the others.",
    "Raise the sample rate to {needed_hz}, or state in the mission how wide a band the receiver hears: then it hears them one after another.",
  ],
  outside_band: [
    "A sample rate of {sample_rate_hz} around {centre_hz} does not hold {refused_hz}.",
    "Tune closer, or raise the sample rate.",
  ],
  recorded_elsewhere: [
    "The recording was made at {recorded_hz}, not at {wanted_hz}.",
    "Give the emitter's frequency as recorded, or another recording.",
  ],
  sample_rate_too_low: ["A sample rate of {sample_rate_hz} is too low.", "Raise the sample rate to at least {needed_hz}."],
  impossible_pulses: [
    "A pulse of {width_s:3} every {period_s:3} is impossible.",
    "Give a width greater than zero and less than the period.",
  ],
  soapy_missing: [
    "SoapySDR is not installed for this Python.",
    "Install the system package python3-soapysdr (and the module of your radio) and make SoapySDR.py visible in this environment (the user guide says how), or use an rtl_tcp:// receiver.",
  ],
  radio_failed: [
    'The radio "{device}" {stage?call=reports a fault|start=does not start|read=has stopped delivering} ({says}).',
    "Check the device string and the cable.",
  ],
  no_receive_channel: ['The radio "{device}" has no receive channel.', "Use a radio that can receive."],
  tuned_elsewhere: ['The radio "{device}" tuned to {tuned_hz} instead of {wanted_hz}.', "Check that this is in its range."],
  rtl_sdr_sample_rate: [
    "An RTL-SDR cannot sample at {sample_rate_hz}.",
    "Choose from 225001 to 300000 or from 900001 to 3200000 samples a second.",
  ],
  rtl_tcp_unreachable: ["The rtl_tcp server at {address} cannot be reached ({detail}).", "Start it there."],
  rtl_tcp_busy: [
    "The rtl_tcp server at {address} {closed?true=closed the connection|false=does not answer}.",
    "Check that it is running and that no other client is connected to it.",
  ],
  not_rtl_tcp: ["The program that listens at {address} is not an rtl_tcp server.", "Correct the address."],
  rtl_tcp_ended: [
    "{broken?true=The connection to the rtl_tcp server at|false=The stream of the rtl_tcp server at} {address} {broken?true=broke|false=ended}.",
    "Check its radio and the network.",
  ],
  payload_starting: ["The payload is opening its receiver."],
  payload_listening: ["The payload listens to {channels|emitter|emitters}."],
  payload_state_unknown: ['The payload\'s receiver is in a state that this server does not know ("{told}").', "Update the server."],
  no_payload_connected: ["No payload is connected.", "Check that its agent is running (crossfix payload), its link and its token."],
  payload_away: ["No payload was connected for {away_s}.", "Check its power and its link."],
  payload_tokens_missing: [
    "The chosen receiver is a payload's, but no payload may connect.",
    "Give the server the tokens of its payloads in CROSSFIX_PAYLOAD_TOKENS.",
  ],
  spool_unusable: ["The payload's spool {path} cannot be used ({detail}).", "Check that the disk is writable, or name another directory."],
  spool_not_written: ["The payload's spool cannot be written ({detail}).", "Check whether its disk is full."],
  other_protocol: [
    "The payload speaks version {theirs} of the protocol, the server version {ours}.",
    "Update the {older?payload=payload's software|server=server}.",
  ],
  message_out_of_turn: [
    "{wrong?no_hello=The payload did not say hello first|second_hello=The payload said hello twice|no_welcome=The server did not say welcome}.",
    "Check that both run Crossfix, and report it if they do.",
  ],
  message_not_understood: ["A message was not understood ({place}: {problem}).", "Update both the payload's software and the server."],
  payload_connected_again: [
    'The payload "{name}" has connected again, which ends the older connection.',
    "If there are two, give one of them another name.",
  ],
  refused_by_server: ['The server closed the connection and said "{says}".'],
  configuration_unreadable: [
    "The configuration {path} is not a readable TOML file ({detail}).",
    "Correct it, or write it again with --save.",
  ],
  configuration_entry_missing: ['The entry "{entry}" of the configuration is missing.', "Give --{option}, or write it into the file."],
  configuration_entry_wrong: ['The entry "{entry}" of the configuration is wrong ({problem}).', "Correct it."],
  pulse_timing_incomplete: [
    "A pulsed tag needs both the width of its pulses and their period.",
    "Give both --pulse-width-s and --pulse-period-s, or neither for a carrier.",
  ],
  home_not_known: ["The simulated emitters stand around the vehicle's home, which is not known yet.", "Wait for a GPS fix."],
  simulator_refused: ["The simulated autopilot refused: {problem}."],
  simulator_silent: ["The simulated autopilot did not answer to {order} within {waited_s:1}.", "Start it again."],
  no_pulse_heard: ["No pulse of the tag was heard in any direction.", "Switch the tag on, or measure nearer to it."],
  rhythm_not_heard: [
    "No pulse in the rhythm of this tag was heard; at its frequency there were {given} pulses of other tags, and {left} that count for none.",
    "Measure nearer to it; check its period and the jitter in the mission.",
  ],
  no_heading_heard: ["The vehicle reported no heading during the turn.", "Check its telemetry link and the rate of ATTITUDE."],
  headings_not_numbers: ["The vehicle's headings are not numbers.", "Calibrate its compass, or restart the autopilot."],
  no_position_heard: ["The vehicle reported no position during the turn.", "Wait for a GPS fix."],
  clocks_apart: ["The power samples and the headings are {apart_s:1} apart.", "Set the clocks of receiver and vehicle by GPS or NTP."],
  headings_interrupted: [
    "Wherever power was heard, the vehicle reported no heading for more than {longest_s:1}.",
    "Look for gaps in the telemetry.",
  ],
  power_not_numbers: ["No power value of the sweep is a plausible number.", "Restart the receiver."],
  overdriven: ["The receiver was overdriven: {clipped} of {samples} samples are clipped.", "Lower its gain, or measure further away."],
  too_few_directions: [
    "Power was heard in only {heard|direction|directions}; at least {needed} around the circle are needed.",
    "Turn slower, or raise the receiver's sample rate.",
  ],
  turn_incomplete: [
    "Power was heard over only {heard_deg} of the turn.",
    "Turn once all the way round while the receiver listens, or nearer to the emitter.",
  ],
  constant_power: [
    "The receiver shows the same power in every direction: a constant, not a signal.",
    "Check its antenna input and its gain.",
  ],
  nothing_above_noise: ["Nothing was heard: no direction is {needed_db:0} above the noise floor.", "Measure nearer to the emitter."],
  no_direction: ["The sweep shows no direction: the power hardly changes with the heading."],
  unlike_antenna: [
    "The sweep does not look like the antenna (similarity {quality:2}, at least {needed:2} is needed): reflections, interference or no signal.",
  ],
  direction_in_gap: ["The strongest direction lies in a gap of {gap_deg} where the receiver did not listen."],
  pattern_borrowed: [
    "The bearing was found with the pattern of another antenna ({name}), so it is less certain.",
    "Measure the pattern of the antenna that flies: crossfix calibrate.",
  ],
  likely_other_antenna: [
    "The sweep looks like that of another antenna than {name}: its main lobe alone was used.",
    "Check which antenna is mounted, and measure its pattern: crossfix calibrate.",
  ],
  other_direction_likely: ["The sweep fits {other_bearing_deg} nearly as well.", "Listen from another place, too."],
  pulses_not_given: [
    "Several tags send at this frequency: {given} pulses were told apart; {overlapping} of two tags at once, {unclear} that could be more than one's and {strangers} that fit none count for no tag.",
  ],
  nose_swung: [
    "The nose swung by {amplitude_deg} to either side, {swung|time|times} to the end, at {rate_deg_s} and at most {lag_deg} behind{end?near_place=, until the place was near|not_ours=, until another order or another pilot|lags=. Then it did not follow, and was left alone|refused=. Then the autopilot refused, and it was left alone}.",
  ],
  readings_left_out: [
    "{readings|reading|readings} left out: {why?heading_unknown=no heading was heard near enough in time|place_unknown=the vehicle was not sure where it was|overdriven=the receiver was overdriven|at_noise=hardly above the noise|beside_a_turn=beside a place where it turns and listens anyway|pointed_one_way=the antenna pointed one way, so their power shows no direction|too_many=other stretches of the way turned further}.",
  ],
  antenna_agrees: ["Measured {measured_deg}, true {true_deg}, quality {quality:2}."],
  not_the_measured_antenna: [
    "This is not the antenna that was measured: {sweeps} sweeps deviate from the pattern {name} by {repeats_db:1} in the same way.",
    "Check which antenna is mounted and how, or take over the proposed pattern.",
  ],
  emitter_too_near: ["The emitter is only {distance_m} away.", "Turn at least {least_m} away from it."],
  antenna_dead: [
    "The power changes by only {heard_db} over the turn, the pattern by {pattern_db:0}: the antenna seems dead or not connected.",
    "Check the antenna's cable, connector and element, and that the test emitter is on.",
  ],
  antenna_unlike_pattern: [
    "The sweep does not fit the antenna's pattern. {because}",
    "Check that this is the antenna of the chosen pattern, that its element is whole and that the emitter has the same polarization.",
  ],
  antenna_askew: [
    "The emitter is at {true_deg} but was measured at {measured_deg}.",
    "Set the antenna's offset to {offset_deg}, or turn the antenna; if both are right, calibrate the compass.",
  ],
  receiver_clock_off: ["The receiver's clock is {offset_s:2} off the vehicle's.", "Set both by GPS or NTP, then turn again."],
  too_few_samples: [
    "The sweeps hold only {samples|sample|samples}; a pattern needs at least {needed}.",
    "Turn slower, or fly more sweeps.",
  ],
  no_magnetic_model: ["There is no magnetic model for the year {year}.", "Update pygeomag, or set the declination by hand."],
  not_a_pattern: [
    'The file {file} is not an antenna pattern: {why?json=it is not JSON|format=it does not state the format "crossfix antenna pattern"|relative_bearing_deg=it lacks relative_bearing_deg|gain=it lacks gain|unit=it lacks unit|rows=it holds no rows of angle_deg, gain|numbers=an angle, gain, offset or frequency is not a finite number|counts=it does not have one gain for each angle|positive=a linear gain is not above zero}.',
    "Use a file that crossfix calibrate wrote, or a turntable table of angle_deg, gain_db that ends in .csv.",
  ],
  pattern_row_unusable: ['Line {line} of {file} is not "angle_deg, gain": {row}.', "Repair or remove that line."],
  pattern_unit_unknown: ['The unit "{unit}" of the gains in {file} is not known.', 'Use "dB" or "linear power".'],
  too_few_points: ["The pattern {name} has only {points|point|points}.", "Measure at least {needed} around the whole circle."],
  angle_twice: ["The angle {angle_deg:1} occurs twice in the pattern {name}.", "Keep one row for each angle."],
  pattern_gap: ["The pattern {name} has a gap of {gap_deg} after {after_deg}.", "Measure all the way round, at least every {widest_deg}."],
  implausible_gains: [
    "The gain of the pattern {name} varies by {spread?small=less than|large=more than} {limit_db:0} around the circle.",
    "Check that the antenna's element is whole, and the table's unit.",
  ],
  pattern_of_other_frequency: [
    "The pattern {name} was measured at {measured_hz:1}, not at {wanted_hz:1}.",
    "Use a pattern that was measured at the emitter's frequency.",
  ],
  file_unreadable: ["The file {file} cannot be read ({detail}).", "Check its path and its format."],
  too_many_cells: [
    "Line {line} of {file} has {cells|cell|cells} for {columns|column|columns}.",
    "If numbers have decimal commas, separate columns with semicolons; else name every column in a header line.",
  ],
  file_unusable: [
    "The file {file} {why?not_text=is not a text file|empty=holds no rows of data|no_pulse=holds no pulse (no row that starts with 7)|one_heading=holds fewer than two rows of time and heading|sweeps=holds sweeps, no bearings}.",
    "{why?not_text=Export the recording as CSV|sweeps=Use crossfix sweep, or name no power|*=Check that it is the right file}.",
  ],
  columns_unknown: [
    "The {columns|column|columns} of {file} (line {line}) cannot be told apart.",
    "Name them in a header line: {expected}.",
  ],
  columns_alike: [
    'Columns {column} ("{name}") and {other} ("{other_name}") of {file} (line {line}) have the same name.',
    "Rename the one that is not meant.",
  ],
  headings_in_radians: [
    "The angles in column {column} of {file} ({least:2} to {most:2}) seem to be radians.",
    "Write degrees, and name the column heading_deg or bearing_deg.",
  ],
  power_linear: [
    "The power in column {column} of {file} ({least} to {most}) {by?name=is named as linear|values=seems to be linear}.",
    "Write decibels, and name the column power_db.",
  ],
  cell_unusable: [
    'Line {line} of {file} is left out: "{cell}" in column {column} is not a usable {quantity?kind_of_row=kind of row (7, 10 or 11)|snr=SNR|noise_psd=noise PSD|latitude=latitude|longitude=longitude|utm=UTM value (zone 22N, or 22 beside a column hemisphere)|bearing=bearing|sigma=sigma|time=time|heading=heading|power=power|frequency=frequency|attitude=attitude}.',
  ],
  row_left_out: [
    "Line {line} of {file} is left out: {why?columns=it has too few columns|not_open=it ends a rotation that was never begun|two_offsets=columns 20 and 21 both carry an antenna offset|wide=it has more numbers than there are columns}.",
    "{why?two_offsets=Add a header line that names the right one.|wide=If numbers have decimal commas, separate columns with semicolons; else name every column in a header line.|*=}",
  ],
  rotation_irregular: [
    "The rotation from line {line} of {file} {why?empty=holds no usable pulse and is left out|not_closed=is never closed (no row 11); it ends where the next one begins, or with the file|offset_changes=changes its antenna offset; the commonest is used}.",
  ],
  pulses_outside_rotations: ["Left out of {file}: {pulses|pulse|pulses} outside every rotation."],
  tag_not_heard: ["Tag {tag} was not heard in the rotation from line {line} of {file}.", "Choose one of its tags: {heard}."],
  other_tags_left_out: [
    "Of the rotation from line {line} of {file}, tag {tag} is used, without {pulses|pulse|pulses} of other tags ({others}).",
    "To use another tag, name it.",
  ],
  decibels_assumed: [
    "The power in column {column} of {file} ({least:2} to {most:2}) is taken for decibels.",
    "Name the column power_db if it is.",
  ],
  frequencies_unread: [
    'No frequency in column {column} of {file} can be read, as "{cell}" in line {line}.',
    "Write each as one number, and the unit behind it or in the column's name.",
  ],
  places_apart: [
    "The sweep from line {line} of {file} was taken at places {apart_m} apart.",
    "Number several turns in a column named sweep.",
  ],
  nothing_usable: [
    "The file {file} holds no usable {wanted?bearing=bearing|power=row of heading and power|pulse=pulse}. {because}",
    "{wanted?bearing=Name the columns lat, lon, bearing_deg and, if known, sigma_deg.|power=Name the columns heading_deg and power_db.|pulse=Check that it is the right file.}",
  ],
  one_tag_only: ["{file} holds bearings of the tags {tags}.", "Name one of them."],
  place_not_stated: ["The file {file} does not state where it was recorded.", "Add columns lat and lon, or name the place beside it."],
  remarks_not_listed: ["{remarks|more remark|more remarks} about {file}: not listed one by one."],
  sigmf_field_missing: [
    "The recording {file} does not state {field}.",
    "{field?core:sample_rate=State the samples a second, a number above zero|core:frequency=State one centre frequency in hertz; cut a recording that was retuned into one for each|core:datetime=State when the recording began, as in 2026-05-01T10:00:00Z, or write the times of the headings as seconds since then|core:geolocation=State a GeoJSON point on the earth, or leave it out|core:dataset=Remove it and name the .sigmf-data file like the .sigmf-meta file|core:num_channels=State of how many channels the samples are, one at least, or leave it out|antenna:azimuth_angle=State where the antenna pointed, in degrees, in two annotations at least, or give a table of time and heading beside the recording}.",
  ],
  sigmf_field_unusable: [
    "In the recording {file}, {field} cannot be used: {value}.",
    "{field?core:sample_rate=State the samples a second, a number above zero|core:frequency=State one centre frequency in hertz; cut a recording that was retuned into one for each|core:datetime=State when the recording began, as in 2026-05-01T10:00:00Z, or write the times of the headings as seconds since then|core:geolocation=State a GeoJSON point on the earth, or leave it out|core:dataset=Remove it and name the .sigmf-data file like the .sigmf-meta file|core:num_channels=State of how many channels the samples are, one at least, or leave it out|antenna:azimuth_angle=State where the antenna pointed, in degrees, in two annotations at least, or give a table of time and heading beside the recording}.",
  ],
  sigmf_file_missing: [
    "The recording {file} lacks its file {missing}.",
    "A recording is two files: .sigmf-meta says how it was sampled, .sigmf-data holds the samples.",
  ],
  samples_unusable: [
    "The recording {file} {why?collection=is a collection of several|real=holds real samples, not complex IQ|none=holds no sample|zero=is silent: every sample is zero|too_short=is too short for one power reading}.",
    "{why?collection=Give one recording|real=Record complex IQ|none=Check that its data file is complete|zero=Check that the receiver was running|too_short=Check its sample rate}.",
  ],
  samples_not_numbers: [
    "In the recording {file}, {samples|sample is not a number|samples are not numbers}, the first after {first_s:2}.",
    "Cut them out, or check core:datatype.",
  ],
  no_signal_found: [
    "The recording {file} is silent: nothing stands {needed_db:0} above the noise.",
    "If the emitter is weaker than that, give its frequency.",
  ],
  silent_at: [
    "The recording {file} is silent at {frequency_hz}: the strongest reading stands {above_db} above the noise.",
    "Check the frequency.",
  ],
  no_pulse_at: [
    "No pulse was heard at {frequency_hz} in the recording {file}.",
    "Check the frequency and the tag's pulse width and period.",
  ],
  headings_apart: [
    "The headings run from {from_s:1} to {to_s:1} after the beginning of the recording {file}, the samples only to {samples_s:1}.",
    "Check the times and the sample rate ({sample_rate_hz}).",
  ],
  headings_of_other_length: [
    "The headings of {file} last {headings_s:1}, the samples {samples_s:1}; what they share is used.",
    "Check the recording's sample rate ({sample_rate_hz}).",
  ],
  first_channel_used: [
    "The recording {file} holds {channels} channels; the first is used.",
    "To use another one, write its samples to a recording of their own.",
  ],
  strongest_used: [
    "The strongest signal in the recording {file}, at {frequency_hz}, is used.",
    "To use another signal, give its frequency.",
  ],
  readings_without_heading: [
    "No heading is known for {left_out} of {readings|power reading|power readings} in the recording {file}; they are left out.",
  ],
  not_iq: [
    "The file {file} holds {given?headings=its own headings, and no IQ that needs a table of them|signal=powers, not IQ, so that no frequency and no pulses are looked for in it}.",
    "{given?headings=Leave the table of headings out.|signal=}",
  ],
  recording_unusable: ["The recording {file} cannot be used. {because}", "{because!remedy}"],
  vehicle_link_not_opened: [
    "The vehicle link {url} cannot be opened: {problem}.",
    "Check that the device is there. Another ground station may be using the port.",
  ],
  no_autopilot_answers: ["No autopilot answers on {url} within {waited_s}.", "Switch it on, and check that it sends to this address."],
  heartbeat_stopped: ["An autopilot answered on {url}, but its heartbeat has stopped.", "Check its power and the link."],
  unknown_autopilot: [
    "The autopilot on {url} is neither PX4 nor ArduPilot (MAV_AUTOPILOT {number}).",
    "Connect a vehicle with one of them.",
  ],
  vehicle_not_connected: ["No vehicle is connected on {url}.", "Switch it on and check its link and its address."],
  vehicle_silent: [
    "The {manoeuvre?take_off=take-off|flight=flight|turn=turn|hold=hold|return=return|landing=landing} was given up: nothing was heard from the vehicle for {silent_s}.",
    "Check the link.",
  ],
  position_lost: ["The vehicle does not know its position.", "Wait for a GPS fix."],
  sticks_moved: [
    "The {manoeuvre?take_off=take-off|flight=flight|turn=turn|hold=hold|return=return|landing=landing} is not possible: the pilot took over with the sticks.",
    "Resume when the pilot has given control back.",
  ],
  mode_not_commanded: [
    "The {manoeuvre?take_off=take-off|flight=flight|turn=turn|hold=hold|return=return|landing=landing} is not possible: {who?failsafe=the autopilot's failsafe|*=somebody else} selected {mode}, which Crossfix did not command.",
    "{who?pilot=Resume when the pilot has given control back|failsafe=Hold or resume to take the vehicle from it|nobody=Resume or start to fly again}.",
  ],
  manoeuvre_replaced: [
    "The {manoeuvre?take_off=take-off|flight=flight|turn=turn|hold=hold|return=return|landing=landing} was replaced by the {by?take_off=take-off|flight=flight|turn=turn|hold=hold|return=return|landing=landing}.",
  ],
  autopilot_refused: [
    "The autopilot refused {command?take_off_mode=the mode for taking off|arming=arming|take_off=the take-off|steering_mode=the mode for steering|place=the next place|speed=the speed|spot=holding the spot|turn=the turn|hold=the hold|return=the return|landing=the landing}: {result?temporarily_rejected=temporarily rejected|in_progress=still in progress|denied=denied|unsupported=unsupported|failed=failed|cancelled=cancelled|*=for a reason that it does not give}.{said?=|*= It says: “}{said}{said?=|*=”.}",
    "Read the autopilot's messages.",
  ],
  place_not_taken: [
    "The autopilot does not fly to this place.{said?=|*= It says: “}{said}{said?=|*=”.}",
    "Look at the fence that it holds.",
  ],
  command_unanswered: [
    "The autopilot did not answer {command?take_off_mode=the mode for taking off|arming=arming|take_off=the take-off|steering_mode=the mode for steering|place=the next place|speed=the speed|spot=holding the spot|turn=the turn|hold=the hold|return=the return|landing=the landing} (sent {attempts|time|times}).",
    "Check the link.",
  ],
  mode_not_shown: [
    "The autopilot acknowledged {command?take_off_mode=the mode for taking off|arming=arming|take_off=the take-off|steering_mode=the mode for steering|place=the next place|speed=the speed|spot=holding the spot|turn=the turn|hold=the hold|return=the return|landing=the landing} ({attempts|time|times}), but its mode never showed it.",
    "Read the autopilot's messages.",
  ],
  mode_left: [
    "The vehicle has left the mode in which it obeys {command?take_off_mode=the mode for taking off|arming=arming|take_off=the take-off|steering_mode=the mode for steering|place=the next place|speed=the speed|spot=holding the spot|turn=the turn|hold=the hold|return=the return|landing=the landing}.",
    "Read the autopilot's messages.",
  ],
  not_in_the_air: ["The vehicle is not in the air.", "Take off first."],
  stands_disarmed: ["The vehicle stands disarmed on the ground: there is nothing to {manoeuvre?return=return from|landing=land}."],
  take_off_ignored: ["The autopilot acknowledged the take-off, but the vehicle stayed on the ground.", "Read the autopilot's messages."],
  no_take_off: ["No take-off within {waited_s}. {because}", "{because!remedy}"],
  climb_too_low: ["The vehicle climbed to {reached_m:1} only, not to {wanted_m:1}.", "Look for an altitude limit of the autopilot."],
  no_progress: ["No progress for {waited_s} with {distance_m} to go.", "Check the wind."],
  not_arrived: [
    "The vehicle did not arrive: it is still {distance_m:1} away and {climb_m:1} too high or too low.",
    "Check the wind and the autopilot's messages.",
  ],
  turn_stopped: ["The turn stopped after {turned_deg}."],
  turn_not_made: [
    "The vehicle acknowledged the turn but did not make it: {turned_deg} seen, {ways|way|ways} tried.",
    "Check the wind and the autopilot's messages.",
  ],
  hold_ignored: ["The autopilot acknowledged the hold, but the vehicle does not hover."],
  does_not_hold: ["{because}", "The pilot should take over."],
  parameter_not_set: ["The autopilot did not take {parameter} = {wanted}.", "Set it with its own ground station."],
  vehicle_connected: ["Connected to {autopilot?px4=PX4|ardupilot=ArduPilot} on {url}."],
  vehicle_unheard: ["The vehicle link is lost.", "Check radio, cable and vehicle address; the autopilot's failsafe acts meanwhile."],
  vehicle_heard_again: ["The vehicle link is restored after {outage_s:1}."],
  autopilot_restarted: ["The autopilot has restarted."],
  clock_rate_odd: [
    "The autopilot's clock runs at {rate:2} of ours: its headings cannot be dated.",
    "Restart the autopilot. A simulator needs more processor.",
  ],
  autopilot_said: ["The autopilot says: “{text}”."],
  autopilot_repeats: ["The autopilot says again: “{text}” ({times|time|times})."],
  autopilot_said_more: ["The autopilot said {texts|more thing|more things} than can be shown.", "Read them in the server's log."],
  mode_changed: ["The vehicle is in {mode}."],
  position_jumped: ["The GPS position jumped by {jumped_m}."],
  taken_over: ["The {who?pilot=pilot|failsafe=autopilot's failsafe} took over in {mode}."],
  taken_over_by_sticks: ["The pilot took over with the sticks."],
  switch_undone: [
    "An order that was under way undid the pilot's switch: the vehicle is in {mode}. Nothing more is sent.",
    "The pilot selects the mode again.",
  ],
  operator_in_control: ["The operator took control."],
  still_moving: ["The vehicle holds, but it still moves at {speed_m_s:1}.", "Look at the wind."],
  parameter_set: ["{parameter} was set from {before} to {after}."],
  tried_again: ["{because} Attempt {attempt} follows."],
  link_checked: ["{autopilot?px4=PX4|ardupilot=ArduPilot|unknown=An unknown autopilot} is heard."],
  gps_checked: [
    "{fix?no GPS=No GPS|no fix=No fix|2D=2D fix|3D=3D fix|DGPS=DGPS fix|RTK float=RTK float fix|RTK fixed=RTK fixed|static=Static position|PPP=PPP fix}, {satellites|satellite|satellites}.",
    "Wait for a 3D fix with at least {wanted_satellites|satellite|satellites} under open sky.",
  ],
  satellites_unknown: [
    "{fix?no GPS=No GPS|no fix=No fix|2D=2D fix|3D=3D fix|DGPS=DGPS fix|RTK float=RTK float fix|RTK fixed=RTK fixed|static=Static position|PPP=PPP fix}, but the autopilot does not know how many satellites it has.",
    "Look at the GPS receiver: its position cannot be judged.",
  ],
  remote_id_checked: [
    "{state?good=The Remote ID transmitter works|silent=The Remote ID transmitter has fallen silent|unknown=No Remote ID transmitter reports its state}.",
    "{state?silent=Check its power and its cable|*=Where Remote ID is required, check the transmitter by other means before the flight}.",
  ],
  remote_id_refuses: [
    "The Remote ID transmitter is not ready for a flight: “{text}”.",
    "Mend what it says: often the operator's id or the operator's place is missing.",
  ],
  never_reported: [
    "The autopilot has not reported {what?gps=its GPS|position=its position|heading=its heading|battery=the battery's charge|home=its home|own_checks=how its own checks stand}.",
    "{what?gps=Check that it has a GPS receiver|position=Wait until the autopilot knows where it is|heading=Check the compass: bearings need the vehicle's heading|battery=Set up the battery monitor|home=Wait until the autopilot has set its home (it needs GPS)|own_checks=Wait until it does, and check that it sends SYS_STATUS}.",
  ],
  report_age: [
    "The {what?position=position|heading=heading} is {age_s:1} old.",
    "{what?position=Wait until the autopilot knows where it is|heading=Check the compass: bearings need the vehicle's heading}.",
  ],
  battery_charge: ["The battery holds {charge_percent}.", "Charge it to at least {wanted_percent}."],
  home_set: ["Home is at {lat@lon}."],
  arming_checked: [
    "{state?ready=The autopilot is ready to arm|not_ready=The autopilot is not ready to arm|not_in_this_mode=The autopilot is not ready to arm in its present mode|in_the_air=The vehicle is in the air|not_reported=The autopilot does not report whether it is ready to arm}.{said?=|*= It says: “}{said}{said?=|*=”.}",
    "{state?not_in_this_mode=Select its mode for holding to learn whether it would arm in that|*=Read the autopilot's messages: its own checks refuse to arm}.",
  ],
  control_checked: [
    "{who?pilot=The pilot has control|failsafe=The autopilot's failsafe has control|nobody=Nobody is intervening}.",
    "{who?failsafe=Let it land|*=Give control back with the transmitter, then resume}.",
  ],
  failsafe_parameter: [
    "{watch?station=Ground station lost|station_id=The ground station that its failsafe watches|station_time=Seconds until it takes a silent ground station for lost|fence=Geofence left|transmitter=Transmitter lost|sticks=The pilot's sticks override automatic flight|offboard=Offboard link lost, which Crossfix does not use|battery=Battery low|battery_critical=Battery almost empty}: {parameter} = {value}.",
    "Set {parameter} to {wanted}{watch?station=: else a vehicle without its station hovers until its battery is empty|station_id=, Crossfix' MAVLink system id: the autopilot does not notice the loss of any other|station_time=: 2 to 30 s; later, a vehicle without its station is left to itself for too long|fence=: else the autopilot only reports that the fence was left|transmitter= when a pilot stands by with a transmitter|sticks=: the pilot's sticks must end automatic flight at once|offboard=|battery=: else a vehicle that nobody commands flies until its battery is empty|battery_critical=, in case it does not reach home}.",
  ],
  failsafe_unread: [
    "{watch?station=Ground station lost|station_id=The ground station that its failsafe watches|station_time=Seconds until it takes a silent ground station for lost|fence=Geofence left|transmitter=Transmitter lost|sticks=The pilot's sticks override automatic flight|offboard=Offboard link lost, which Crossfix does not use|battery=Battery low|battery_critical=Battery almost empty}: {parameter} could not be read.",
    "Set {parameter} to {wanted}{watch?station=: else a vehicle without its station hovers until its battery is empty|station_id=, Crossfix' MAVLink system id: the autopilot does not notice the loss of any other|station_time=: 2 to 30 s; later, a vehicle without its station is left to itself for too long|fence=: else the autopilot only reports that the fence was left|transmitter= when a pilot stands by with a transmitter|sticks=: the pilot's sticks must end automatic flight at once|offboard=|battery=: else a vehicle that nobody commands flies until its battery is empty|battery_critical=, in case it does not reach home}.",
  ],
  failsafe_without_threshold: [
    "{watch?station=Ground station lost|station_id=The ground station that its failsafe watches|station_time=Seconds until it takes a silent ground station for lost|fence=Geofence left|transmitter=Transmitter lost|sticks=The pilot's sticks override automatic flight|offboard=Offboard link lost, which Crossfix does not use|battery=Battery low|battery_critical=Battery almost empty}: {parameter} is set, but {voltage_parameter} and {charge_parameter} {known?true=are both 0: it never acts|false=could not both be read: it may never act}.",
    "Set {voltage_parameter} to the voltage, or {charge_parameter} to the mAh left, at which it is to act.",
  ],
  parameter_to_set: ["{parameter} goes from {before} to {after}."],
  nets_to_set: [
    "The start sets the autopilot's own fence: {corners|corner|corners}, {no_fly|no-fly area|no-fly areas}. {own_zones?0=It holds no other|*=Its own makes room meanwhile}; after the flight everything is put back as it was. {changes}",
  ],
  own_ceiling_lower: [
    "The autopilot's own fence ends at {own_m} ({parameter}), the mission's at {ceiling_m}.",
    "Lower the mission's ceiling, or raise {parameter} with the vehicle's ground station.",
  ],
  own_fence_tighter: [
    "The mission's fence reaches {beyond_m} beyond the fence that the autopilot holds already.",
    "Draw the mission's fence inside it, or change the vehicle's own with its ground station.",
  ],
  fence_too_detailed: [
    "Fence and no-fly areas have {corners|corner|corners}; the autopilot can hold {most}.",
    "Draw them with fewer corners.",
  ],
  fence_not_transferred: [
    "The autopilot's fence could not be {way?read=read|sent=sent} ({why}).",
    "Check the link; a fence on the autopilot's storage card may be damaged.",
  ],
  fence_unknown_form: [
    "The autopilot holds a fence that Crossfix does not understand ({what}).",
    "Look at it with the vehicle's ground station, and clear it there.",
  ],
  fence_read_back_different: [
    "The autopilot holds another fence than it was sent: corner {corner} differs.",
    "Try again; when it stays so, set the fence with the vehicle's ground station.",
  ],
  fence_parameter_unread: ["The autopilot's fence cannot be judged: {parameter} could not be read.", "Check the link and try again."],
  sign_in_needed: ["Nobody is signed in here, or the session has ended.", "Sign in."],
  first_admin_needed: [
    "This server has no people yet, so it does nothing for anybody.",
    "Open its page and make the first admin with the code that the server printed when it started.",
  ],
  first_admin_exists: ["The first admin has been made; the code works once.", "Sign in, or ask an admin for an invitation."],
  no_people_here: [
    "This server listens to this machine only and has no accounts.",
    "To let others in, start it with --users, or with --host and an address of this machine.",
  ],
  behind_proxy: [
    "The request came through a proxy, and this server has no accounts.",
    "Start it with --users, and name the proxy in CROSSFIX_TRUSTED_PROXIES.",
  ],
  role_too_low: [
    "This takes {needed?viewer=a signed-in person|operator=an operator|pilot=a pilot|admin=an admin}; {role?viewer=a viewer|operator=an operator|pilot=a pilot|none=a machine's token} may not do it.",
    "Ask an admin for another role.",
  ],
  call_not_listed: ["Nobody may make this call: it is missing from the table of permissions.", "Report it; this is a fault of ours."],
  origin_missing: [
    "A signed-in page must say where it comes from, and this request did not.",
    "Use the page that this server serves; programs use a machine's token.",
  ],
  not_encrypted: [
    "The connection is not encrypted: others on the network could read the password.",
    "Open the page by https:// through the proxy. On a network that encrypts by itself, set CROSSFIX_PLAIN_HTTP.",
  ],
  wrong_name_or_password: ["Name or password is wrong.", "Try again, or ask an admin for an invitation."],
  no_password_here: ["This account has no password here: it signs in through the sign-in provider.", "Change the password there."],
  no_provider: ["This server has no sign-in provider.", "Sign in with a name and a password, or set CROSSFIX_OIDC_ISSUER."],
  provider_refused: [
    "{fault?return=The way back from the sign-in provider was used already, took longer than ten minutes, or began in another browser|refused=The sign-in provider did not sign you in|away=The sign-in provider does not answer|answer=The answer of the sign-in provider could not be accepted|clock=The sign-in provider and this server disagree about the time|email=Your email address is not verified, or not of a domain that may enter|role=The sign-in provider gives you no role here|shut_out=An admin has shut this account out}.",
    "{fault?return=Begin again on this page.|refused=Try again, or ask whoever runs the provider.|away=Try again later, or sign in with a password.|answer=Ask whoever runs this server: its log says what was wrong.|clock=Set the clock of this server.|email=Ask whoever runs the provider or this server.|role=Ask whoever runs the provider for a group that this server knows.|shut_out=Ask an admin.}",
  ],
  too_many_tries: ["There were too many tries.", "Try again in {wait_s}."],
  code_unusable: [
    "This code {fault?unknown=is not known|used=has been used; each works once|expired=has expired}.",
    "{fault?unknown=Look whether it was copied whole.|*=Ask for a new one.}",
  ],
  name_taken: ["Somebody here is called {name} already.", "Choose another name."],
  password_weak: [
    "The password {fault?short=is too short|simple=uses too few different characters|name=holds the name}.",
    "Take at least {least} characters; a few words that only you put together are best.",
  ],
  last_admin: ["This is the last admin.", "Make somebody else admin first."],
  command_id_reused: [
    'This command id belongs to another order ("{command}") already; nothing was done.',
    "Send each order with an id of its own.",
  ],
  control_free: ["Nobody controls this search.", "Take control first."],
  control_held: ["{name} controls this search.", "Ask for control; a pilot can take it at once. Hold and abort need none."],
  control_stale: ["This order was given before control changed hands; nothing was done.", "Look at what is so now, then order again."],
  control_asked_already: ["{name} has asked for control already.", "Wait for the answer."],
  control_not_asked: ["Nobody asks for control."],
  control_not_yours: ["You do not control this search."],
  control_needless: ["This server has no accounts: whoever sits before it controls every search."],
  home_moves_here: [
    "The autopilot's home is {away_m} away. It moves here when the vehicle is armed, unless somebody has fixed it; then its own return leads there.",
    "If a ground station has set the home, set it to where the vehicle stands.",
  ],
  return_altitude_checked: [
    "The autopilot's own return climbs to {altitude_relative_m} ({parameter}).",
    "Set {parameter} so that the autopilot's own return stays at or below the mission's ceiling of {ceiling_relative_m}, or raise that.",
  ],
  return_altitude_unread: [
    "How high the autopilot's own return climbs ({parameter}) could not be read.",
    "Set {parameter} so that the autopilot's own return stays at or below the mission's ceiling of {ceiling_relative_m}.",
  ],
  return_climbs: [
    "The autopilot's own return climbs by {climb_m} from however high it begins ({parameter}): from {from_relative_m} that leads above the mission's ceiling of {ceiling_relative_m}.",
    "Set {parameter} to 0, or raise the mission's ceiling.",
  ],
  return_meets_ground: [
    "The autopilot's own return climbs to {altitude_relative_m} ({parameter}) and flies straight home: over the ground in between it needs {least_relative_m}.",
    "Set {parameter} to at least {least_relative_m}, and the mission's ceiling no lower; or choose another home.",
  ],
  room_to_fly: ["There are {area_m2} to fly in."],
  start_allowed: ["Fence, battery and position allow the start."],
  receiver_delivers: ["The receiver delivers samples on {channels|channel|channels}."],
  receiver_takes_turns: [
    "The receiver works. Its band holds the {channels} channels in {rounds} groups, one after another: the craft goes round once for each, which takes {turn_s} at every place, and less once emitters are found.",
  ],
  turn_takes_long: [
    "The receiver works. The pulses come so seldom that a turn takes up to {turn_s} at every place.",
    "Where they come every few seconds, fewer of them a heading make it shorter; see that the battery lasts for two turns.",
  ],
  few_turns_on_a_battery: [
    "A turn takes {turn_s}. As long as wind and craft are not known, not even a full battery is sure to last for {turns} of them in the middle of the area, and no search does with fewer.",
    "Look for fewer emitters or for a signal that is sent more often, or lower the reserve of a craft that stays up for long.",
  ],
  few_turns_on_this_charge: [
    "At {charge_percent} the battery may not last for {turns|turn|turns} of {turn_s}, the ways to the far end of the area and home, and the reserve. No search takes fewer turns.",
    "Change the battery, or expect the craft to come home before it has found anything.",
  ],
  first_turn_in_little_wind: [
    "If it is windy, the battery, at {charge_percent}, may not last for the first turn, {far_m} away, and the way home.",
    "Take off nearer to the area or with a fuller battery, or expect the craft to come home before it has turned.",
  ],
  no_samples: ["The receiver delivers no samples.", "Check that it is plugged in and not in use by another program."],
  tag_unheard: [
    "The receiver works, but hears no pulse of the tag at {frequency_hz}.",
    "Bring the tag nearer, or accept that it is out of range here.",
  ],
  pattern_in_use: ["The antenna pattern is {name}."],
  no_vehicle_yet: ["No vehicle has answered on {address} yet.", "Switch it on and check its link and address."],
  connecting_broke: ["Connecting to {address} failed inside Crossfix and is tried again."],
  datagram_too_long: ["It has {size} bytes; {most} are the most.", "Leave the raw directions out."],
  datagram_no_bearing: [
    'It is {what?json=not JSON|bearing=no object of type "BEARING"}.',
    "Send one bearing in each datagram, and nothing else to this port.",
  ],
  datagram_not_absolute: ['Its bearing_type is not "absolute".', "Send the bearing from true north, and the place."],
  datagram_value_unreadable: ["Its {name} is no {wanted?number=number|text=text|emitter=emitter's id}.", "Mend what the sender writes."],
  datagram_value_impossible: ["Its {name} is {value}; it must be between {least} and {most}.", "Mend what the sender writes."],
  sender_too_busy: ["Its sender sends too many.", "Let it send at most five a second."],
  too_many_wait: ["Too many wait to be taken.", "Let the stations send less often."],
  same_errors_again: ["One of {station} from the same place was taken less than {within_s} ago; it has the same errors."],
  no_search_flies: ["No search flies.", "Start one; bearings for a draft are sent by HTTP."],
  ordered: [
    "{order?start=Started|resume=Resumed|hold=Held|return=Return ordered|land=Landing ordered|abort=Aborted|override=Place chosen|accept=Place accepted|veto=Place refused|automatic=Automatic acceptance armed|exclude=Bearing excluded} by {by}.",
  ],
  proceeds: [
    "{after?climb=At altitude|plan=The next place is chosen|flight=The place is reached|bearing=The bearing is taken|belief=The belief is updated|way_home=Above home|area=The search area has changed}.",
  ],
  no_console: ["{stage?hold=No console is connected|return=No console came back}.", "Connect a console and resume."],
  vehicle_link_lost: ["The link to the vehicle is lost.", "Its own failsafe acts meanwhile. Restore the link."],
  place_unknown: [
    "The vehicle has lost GPS: it no longer knows where it is.",
    "Be ready to fly it by hand: its autopilot will soon land where it is.",
  ],
  battery_runs_low: [
    "The battery holds only {charge_percent}.",
    "Order the return or the landing: without a mission nobody reckons what the way home takes.",
  ],
  payload_link_lost: ["The link to the companion computer is lost.", "Check the companion's power and network."],
  back_after_restart: ["The server restarted.", "Look at the vehicle, then resume."],
  server_ends: ["The server is being ended.", "Start it again, look at the vehicle, then resume."],
  pilot_flies: [
    "{perhaps_failsafe?true=The pilot or the autopilot's failsafe has|false=The pilot has} control{mode?=, taken with the sticks|*=: the vehicle is in }{mode}.",
    "Resume when the pilot has given control back.",
  ],
  failsafe_flies: [
    "The autopilot returns or lands by itself: {because?silence=it had not heard from here|link_lost=the link was lost|server_away=the server was away|ordered_before=as ordered earlier|battery=battery low|transmitter=transmitter lost|position=position lost|fence=geofence left|other=a failsafe of its own}.",
    "Resume to go on searching, or let it land.",
  ],
  failsafe_stopped: [
    "The autopilot's own way home ended in {mode}, perhaps by an earlier order.",
    "Look at the vehicle, then hold or resume.",
  ],
  landed: [
    "The vehicle landed {during?hold=while the mission was held|automatic=although nothing ordered it|manual=while the pilot or its own failsafe had control|localized=and the emitter is localized}.",
    "{during?manual=|localized=|*=Resume to take off again, abort to end the mission.}",
  ],
  other_antenna: [
    "The server was restarted with another antenna pattern ({given}); this mission keeps its own ({flown}).",
    "Where the antenna itself was changed, land and begin another mission.",
  ],
  step_broke: [
    "{step?take_off=Taking off|fly=Flying|measure=Measuring|plan=Planning|belief=Updating the belief|hold=Holding|return=Returning|land=Landing} failed inside Crossfix.",
    "Look at the vehicle and resume, or order the return.",
  ],
  watch_broke: [
    "{watch?vehicle=Watching the vehicle|changes=Listening to the vehicle|track=Keeping the track} failed inside Crossfix.",
    "Look at the vehicle and resume, or order the return.",
  ],
  place_unsure: [
    "The place of bearing {place_number} is uncertain by {drift_m}; it counts for less.",
    "Its reported position jumped, or wind moved it: look at GPS and wind.",
  ],
  not_stored: ["Not everything of this mission can be stored: {detail}.", "It is kept beside the journal's spool; the flight goes on."],
  not_an_archive: [
    "The file is not a PMTiles archive{looks_like?none=|empty=: it is empty|sqlite=, it looks like an MBTiles or another SQLite file|zip=, it is a zip file|gzip=, it is gzip-compressed|tiff=, it is a TIFF picture|png=, it is a PNG picture|jpeg=, it is a JPEG picture|json=, it looks like JSON|xml=, it looks like XML or a web page}.",
    "Only PMTiles archives (.pmtiles, version 3) can be used. MBTiles files are converted with `pmtiles convert`.",
  ],
  old_archive: [
    "The PMTiles archive has version {version}; version 3 is needed.",
    "Only PMTiles archives (.pmtiles, version 3) can be used. MBTiles files are converted with `pmtiles convert`.",
  ],
  tiles_not_drawable: [
    "The archive's tiles are of type {tile_type}, which the map cannot draw.",
    "Vector tiles must be MVT, pictures PNG, JPEG, WebP or AVIF.",
  ],
  compression_not_read: [
    "The archive is compressed with {compression}, which a browser cannot unpack.",
    "Make it with gzip compression, the default of the PMTiles tools.",
  ],
  archive_damaged: [
    "The PMTiles archive is damaged in its {part?header=header|metadata=metadata|directories=directories|tiles=tiles|first_tile=first tile}: {fault?cut_off=there is less than it states|unreadable=it cannot be read|senseless=the values make no sense|too_large=there is more than any map needs|missing=there is nothing|endless=it points to itself without end|not_as_stated=the picture is not of the type that it says}.",
    "{fault?cut_off=Copy or download the whole file again.|*=Export or extract the map again, for example with `pmtiles extract`, and upload the new file.}",
  ],
  map_label_damaged: ["The map's label is missing or damaged.", "Upload the map again."],
  put_by_hand: ["It was put into the map folder by hand.", "Upload it on the page instead."],
  map_unusable: ["Map {file}: {because}", "{because!remedy}"],
  upload_incomplete: ["Only {arrived_bytes} of {announced_bytes} arrived.", "Upload it again; nothing was kept."],
  no_room_for_map: [
    "The file does not fit: {needed_bytes} more are needed, {room_bytes} may be used.",
    "Delete maps or overlays that are not needed. {reserve_bytes} stay free for the journal.",
  ],
  map_drawn_plainly: [
    "{because?layers_not_named=The archive does not say which layers its tiles have, so nothing of it can be drawn|schema_unknown=The map's layers follow no schema that is known here; all of them are drawn alike}.",
  ],
  area_on_maps: [
    "{shown?whole=The whole area is on the offline maps|partly=Only a part of the area is on the offline maps; the rest is plain grid|not_finely=No offline map shows the area finely enough to fly by: the plain grid is shown|no_map=There is no offline map: the plain grid is shown} ({shown_percent}).",
  ],
  beyond_web_maps: ["The area lies beyond 85 degrees of latitude, where web maps end.", "Fly with the plain grid."],
  not_readable_as: [
    "The file cannot be read as {format?geojson=GeoJSON|kml=KML|kmz=KMZ|none=GeoJSON, KML or KMZ}: {fault?empty=it is empty|other_format=it is something else|not_json=it is not valid JSON|no_type=it is JSON without a `type`|no_features=its FeatureCollection has no list of `features`|not_xml=it is not valid XML|document_type=it holds a document type definition|other_xml=its first element is not <kml>|not_unpacked=it cannot be unpacked|no_kml_inside=there is no KML file in it|too_large=it is far too large when unpacked}.",
    "Export it as GeoJSON in WGS84 (longitude, latitude), or as KML or KMZ with placemarks.",
  ],
  other_coordinates: ["The file uses the coordinate system {system}, not WGS84.", "Export it in WGS84 (longitude, latitude)."],
  too_many_features: ["The overlay has more than {most} features.", "Leave out what is not needed, or make a map package (PMTiles) of it."],
  part_left_out: [
    "{part?feature=Feature|placemark=Placemark} {which} is left out: {fault?missing=it has no geometry that can be drawn|type_unknown=its type of geometry is not known|nested_too_deep=its geometries are nested too deep|no_position=a position lacks its longitude or latitude|not_numbers=its coordinates are not numbers|swapped=a position is not on Earth; longitude and latitude may be swapped|in_metres=a position is not on Earth; it may be in metres|too_few_positions=a line needs two positions and a ring three corners}.",
  ],
  file_left_out: ["The archive also holds {file}, which is left out."],
  kind_left_out: [
    "{kind?NetworkLink=Links to other files|GroundOverlay=Pictures on the ground|ScreenOverlay=Pictures on the screen|PhotoOverlay=Photos|Model=3D models|Tour=Tours|known_bearing=Known bearings} are left out ({count}).",
  ],
  more_left_out: ["{parts|more part was|more parts were} left out."],
  nothing_to_draw: ["The file holds nothing that can be drawn. {left_out}", "Use another file."],
  not_areas: ["{count|point or line was|points or lines were} left out."],
  polygons_united: ["{polygons} polygons that touch or overlap were merged into {areas}."],
  positions_thinned: ["Of {before} positions {after} are drawn; lines lie within {tolerance_m:1} of the file's."],
  overlay_unusable: ["Overlay {file}: its description is damaged.", "Upload the overlay again."],
  no_polygon: [
    "The file holds no polygon.",
    "{lines?true=A line is not an area: close it into a polygon.|false=Draw the area as one or more polygons and export it as GeoJSON (WGS84) or KML.}",
  ],
  not_started: ["The mission has not started.", "Start it first."],
  already_started: ["The mission has started already.", "Draft a new one to fly again."],
  mission_over: ["The mission has ended.", "Draft a new one."],
  not_held: ["The mission is not held.", "To go on from here, hold it first."],
  later_order_counts: ["An order that was given later on the same page has been accepted already."],
  no_countdown: ["Nothing counts down: the countdown is over, or was stopped before."],
  landing_already: ["The vehicle is landing at home already.", "Hold stops the landing."],
  on_the_way_home: ["The vehicle is on its way home.", "Hold and resume first, to go on searching."],
  on_the_ground: ["The vehicle is on the ground."],
  area_only_in_hold: ["The search area can only be changed in hold.", "Hold, then change it."],
  nets_changing: [
    "The autopilot does not have the fence of the new search area yet.",
    "It is given it until it has it; return and landing do not wait.",
  ],
  no_proposed_place: ["No place is proposed.", "Wait for the planner's next place."],
  place_refused_before: [
    "The place is {near_m:1} from one that the autopilot has refused to fly to.",
    "Choose a place {least_m} or more from it.",
  ],
  no_such_bearing: ["This mission has no such bearing.", "Reload the page."],
  bearing_of_another: ["This bearing was reported under another name.", "Ask an operator to exclude it."],
  bearing_excluded_already: ["The bearing is excluded already."],
  bearing_counts_already: ["The bearing was not left out."],
  left_out_by_another: ["{by} left it out.", "Ask {by}, or whoever controls the search, to count it again."],
  no_such_source: ["No bearing of this search comes from there.", "Reload the page."],
  muted_already: ["The source is {muted?true=muted already|false=not muted}."],
  no_such_alert: ["There is no such open alert.", "It may have cleared by itself."],
  no_such_craft: ["No craft {craft_id} flies for this mission.", "Reload the page."],
  no_such_emitter: ["This mission looks for no emitter {emitter_id}.", "Reload the page."],
  vehicle_unknown: ["Nothing is known of the vehicle.", "Connect the vehicle and ask again."],
  no_home: ["The vehicle's home is not known yet.", "Wait for a GPS fix."],
  another_mission_flies: ["Another mission is still flying: {name}.", "End it and let the vehicle land first."],
  no_mission: ["There is no mission {mission_id}.", "Look at the list of missions."],
  not_editable: ["The mission has started and can no longer be edited.", "In hold, change its search area; or draft a new mission."],
  edited_meanwhile: [
    "The mission has been saved since you opened it, by {by}.",
    "Look at what they saved; then save yours over it, or begin again from theirs.",
  ],
  drafted_before: ["The mission {mission_id} was drafted before.", "Open it and edit it."],
  mission_flies: ["A mission is flying.", "Check the antenna when the vehicle is down."],
  mission_does_not_fly: ["The mission is not flying.", "Edit the draft, or draft a new mission."],
  server_is_ending: ["The server is being ended: it only holds, returns and lands.", "Start it again first."],
  still_under_way: ["The mission is under way.", "Delete it when it is over and its vehicle is down."],
  was_deleted: ["The mission was deleted.", "Restore it first: it is among the deleted ones in the list of missions."],
  too_many_variants: ["This mission has {most} variants, the most it may.", "Forget one of them first."],
  field_missing: ["It is missing."],
  field_unknown: ["There is no such field."],
  field_out_of_range: [
    "It must be {relation?greater_than=greater than|greater_than_equal=at least|less_than=less than|less_than_equal=at most} {bound}.",
  ],
  field_wrong_length: ["It must have {relation?least=at least|most=at most} {length|item|items}."],
  field_not_one_of: ["It must be one of {expected}."],
  field_invalid: ["It is not valid: {message}."],
  request_invalid: [
    "The request is not valid: {faults|field is|fields are} wrong, first {field}.",
    "Correct the named fields and send it again.",
  ],
  nothing_there: [
    "There is no {what?mission=mission|page=page|belief_about=belief about|belief_at=belief at the event|belief_after=belief after this many bearings:|sweep=sweep|map=map|overlay=overlay|terrain=terrain|file=file|recording=recording|craft=craft|scene=3D view|person=person|session=session|invitation=invitation|token=token} {which}.",
    "It may have been removed, or its name has a mistake in it: look at what there is and choose again.",
  ],
  iq_not_kept: [
    "No IQ was kept of this mission, only the power of its sweeps.",
    "IQ is kept of SigMF recordings that are imported; export everything for the power, sample by sample.",
  ],
  http_refused: ["The request was refused ({status}): {phrase}."],
  body_too_large: [
    "{what?mission=The file of a mission|other=A request} may have at most {most_bytes}.",
    "{what?mission=Choose the zip file that “All of it” saves under “Take away”: it is packed. If this is it, the mission is longer than any that can be read.|other=Simplify the geometry, or split the file.}",
  ],
  body_too_rich: ["A request may have at most {most_fields} named fields and {most_items} items in its lists.", "Simplify the geometry."],
  body_too_slow: ["Nothing of the request arrived for {wait_s}.", "Look at the network, then send it again."],
  unknown_host: [
    "This server does not go by the name {host}.",
    "Open it by its IP address or localhost, or name the host in CROSSFIX_ALLOWED_HOSTS.",
  ],
  foreign_origin: ["A page of {origin} may not command this server.", "Use the page that this server serves."],
  samples_not_stored: [
    "The power samples of place {place_number} were not stored, so no other antenna can hear them.",
    "Ask with another bearing error, share of wrong bearings or planner: these need no samples.",
  ],
  half_given: [
    "{pair?place=A place needs both latitude and longitude|pulses=A pulsed tag needs both its pulse width and its period}.",
    "Give both, or neither.",
  ],
  too_many_files: ["{files|file is|files are} more than one recording.", "Upload one file, or meta, data and headings."],
  two_recordings: ["The files {first} and {second} are two recordings.", "Upload them one after the other."],
  export_unreadable: [
    "This {fault?not_json=is not JSON|not_exported=is not a mission that Crossfix exported|later=was exported by a later Crossfix}.",
    "{fault?later=Open it with that Crossfix.|*=Choose the file mission.json of an export.}",
  ],
  bundle_unreadable: [
    "{fault?not_zip=This is not a zip file|too_large=The files in the bundle are larger than those of any mission|later=A later Crossfix wrote this bundle|under_way=The mission was still under way when the bundle was written|differs=This installation has the same mission with other facts}.",
    "{fault?later=Open it with that Crossfix.|under_way=Export it again after it has ended.|differs=Nothing was changed. Open the mission that is here.|*=Choose the zip file that “All of it” saves under “Take away”, unchanged.}",
  ],
  bundle_file_wrong: [
    "{fault?foreign=Crossfix writes no such file into a bundle|damaged=A file in the bundle is damaged|not_exported=A file in the bundle is not one that Crossfix exported}: {name}.",
    "Choose the zip file that “All of it” saves under “Take away”, unchanged.",
  ],
  bundle_fact_wrong: [
    "Event {seq} in the bundle’s mission.json {fault?place=tells an estimate that is no place on Earth|region=tells a 95 % region that is no area|spread=tells an uncertainty or a number that cannot be|unknown_bearing=leaves out, or takes in again, a bearing that there is not|bearing_twice=tells a bearing whose id another one has|not_started=tells of a craft that had not started|name=gives a name whose characters turn the direction of writing|id=names a sweep with characters that no id has}.",
    "Nothing was brought in. Choose the zip file that “All of it” saves under “Take away”, unchanged.",
  ],
  upload_broke_off: ["The upload broke off; nothing was kept.", "Upload the file again."],
  no_payload_expected: [
    "This server takes no samples from a payload.",
    "Start it with CROSSFIX_PAYLOAD_TOKENS, a list of the tokens its payloads may show.",
  ],
  unknown_token: [
    "The server does not know this token, or it lasts no longer.",
    "Ask an admin for a new one, or take one of those in CROSSFIX_PAYLOAD_TOKENS for a payload.",
  ],
  too_many_scenes: ["Too many 3D views are open.", "Close one in another tab."],
  scene_silent: ["The 3D server does not answer.", "Load the view again."],
  server_broke: [
    "The request could not be carried out because of a fault in the server (incident {incident}).",
    "The mission goes on. Try again; if it happens again, report the incident with the server's log.",
  ],
  failsafe_acts: ["The autopilot acts by itself: {mode}.", "Hold or resume first."],
  pilot_controls: ["The pilot has control: nothing is sent to the vehicle.", "Resume when the pilot has given control back."],
  not_given_back: [
    "The pilot has not given control back: the vehicle is still in {mode}.",
    "The pilot selects HOLD (PX4) or BRAKE or GUIDED (ArduPilot) on the transmitter, then resume.",
  ],
  no_link: ["The link to the vehicle is lost.", "Wait until the vehicle answers again; its own failsafe acts meanwhile."],
  no_position: ["The vehicle has no position.", "Wait for a GPS fix."],
  position_old: ["The vehicle's position is {age_s:1} old.", "Wait until telemetry arrives again."],
  battery_unknown: [
    "The vehicle does not report its battery.",
    "Set up the battery monitor, or say in the mission that this vehicle reports no battery.",
  ],
  battery_silent: ["The battery's charge is no longer reported.", "Check the battery monitor."],
  battery_short: [
    "Battery at {charge_percent}: the way home would begin at {left_percent} and takes {needed_percent}; the reserve is {reserve_percent}.",
    "Return home and change the battery.",
  ],
  turn_beyond_battery: [
    "A turn takes {turn_s}, for which {takes_percent} of a battery is set aside as long as wind and craft are not known. With {needed_percent} for the way home and a reserve of {reserve_percent} no battery is full enough.",
    "Look for fewer emitters or for a signal that is sent more often, or lower the reserve of a craft that stays up for long.",
  ],
  first_turn_beyond_charge: [
    "Battery at {charge_percent}: the craft would come home before its first turn, {far_m} away. To get there and turn {takes_percent} is set aside, {needed_percent} for the way home, and the reserve is {reserve_percent}.",
    "Charge or change the battery, take off nearer to the area, or draw one that is nearer.",
  ],
  first_turn_beyond_battery: [
    "The craft would come home before its first turn, {far_m} away: to get there and turn {takes_percent} is set aside as long as wind and craft are not known, {needed_percent} for the way home, and the reserve is {reserve_percent}. No battery is full enough.",
    "Take off nearer to the area, draw one that is nearer, or lower the reserve of a craft that stays up for long.",
  ],
  altitude_outside: [
    "{altitude_relative_m} above home is outside the allowed {lowest_relative_m} to {highest_relative_m}.",
    "Change the mission's altitude or its band.",
  ],
  too_far_from_home: ["The place is {distance_m} from home, more than {most_m}.", "Choose a place nearer to home."],
  already_in_air: ["The vehicle is already in the air.", "Land it; a mission starts on the ground."],
  outside_fence: [
    "{what?vehicle_stands=The vehicle stands|vehicle=The vehicle is|home=Home is|place=The place is} {beyond_m} outside the fence.",
    "{what?place=Choose a place inside, or widen the fence.|*=Draw the fence around the vehicle and its home.}",
  ],
  inside_no_fly: [
    "{what?vehicle_stands=The vehicle stands|vehicle=The vehicle is|home=Home is|place=The place is} inside a no-fly zone.",
    "{what?place=Choose a place outside the zone.|*=Draw the no-fly zones beside the vehicle and its home.}",
  ],
  near_no_fly: [
    "The place is {near_m:1} from a no-fly zone, and a hovering vehicle wanders.",
    "Choose a place {least_m} or more from the zone.",
  ],
  way_leaves_fence: ["The way there leaves the fence.", "Fly by way of a place in between."],
  way_crosses_no_fly: ["The way there crosses a no-fly zone.", "Fly by way of a place beside the zone."],
  no_way_home: [
    "From where the vehicle is no way around the no-fly zones and inside the fence leads home, {distance_m} away.",
    "Draw the fence and the no-fly zones so that there is one.",
  ],
  ground_unknown: [
    "{where?way_there=The way there|way_home=The way home from there|take_off=The take-off} leads over ground whose height the terrain does not know.",
    "Upload terrain for the whole fence, or remove the terrain: the ground then counts as level with home.",
  ],
  clearance_short: [
    "{where?way_there=The way there|way_home=The way home from there|take_off=The take-off} at {altitude_relative_m} above home is only {clearance_m:1} above the ground; {least_m:1} are needed.",
    "Choose another place, or allow more altitude above home.",
  ],
  too_high_above_ground: [
    "{where?way_there=The way there|way_home=The way home from there|take_off=The take-off} at {altitude_relative_m} above home is {height_m:1} above the ground; {most_m:1} are allowed.",
    "Choose a nearer place: the ground falls away below one level way.",
  ],
  area_empty: [
    "{what?area=The area|fence=The fence|no_fly=A no-fly zone|confidence_region=The confidence region} is empty.",
    "Draw at least three corners.",
  ],
  too_few_corners: [
    "{what?area=The area|fence=The fence|no_fly=A no-fly zone|confidence_region=The confidence region} has fewer than three different corners.",
    "Draw at least three.",
  ],
  too_many_corners: [
    "{what?area=The area|fence=The fence|no_fly=A no-fly zone|confidence_region=The confidence region} has more than {most} corners.",
    "Simplify it.",
  ],
  outline_unusable: [
    "{what?area=The area|fence=The fence|no_fly=A no-fly zone|confidence_region=The confidence region} {fault?crosses_itself=has an outline that crosses itself|hole_outside=has a hole outside its outline|not_simple=is not a simple polygon}.",
    "Move the corners so that no two edges cross.",
  ],
  area_too_small: ["The area has only {area_m2}.", "Draw at least {least_m2}."],
  area_too_wide: ["The area is {width_m} wide.", "Search at most {most_m} at a time."],
  area_too_far: ["The area is {distance_m} away from the vehicle.", "Draw the area where the vehicle is, or carry the vehicle there."],
  headings_askew: [
    "All bearings seem to be off by the same angle, about {offset_deg} ± {std_error_deg}: the place found may be wrong.",
    "Check compass and antenna mounting; a single wrong place can look the same.",
  ],
  bearings_corrected: [
    "All bearings are turned by about {bias_deg} ± {std_error_deg}; the belief takes that into account.",
    "Check compass and antenna mounting before the next flight.",
  ],
  belief_broke: [
    "Updating the belief about {emitter_id} failed inside Crossfix: no next place is planned.",
    "Leave out the bearing that came last, or order the return.",
  ],
  localized: ["Localized: the expected error is within the goal."],
  localized_against: ["Localized: the expected error is within the goal; it stands against {against} of {bearings|bearing|bearings}."],
  recording_too_long: ["The recording holds {sweeps} sweeps.", "Import at most {most} at once."],
  recording_too_far: [
    "The recording was taken {distance_m} from the mission's area.",
    "Import it into a mission whose area is around it, or name the right place.",
  ],
  place_too_far: ["The place is {distance_m} from the search's area.", "Check the place, or report it to the search that it belongs to."],
  asked_from_too_far: [
    "You are {distance_m} from the search's area: too far to be advised where to listen.",
    "Go nearer, or say where you will be.",
  ],
  heard_elsewhere: [
    "The bearing was heard at {frequency_hz}, where nothing is looked for.",
    "Tune the station to a frequency of the search.",
  ],
  kraken_unreadable: [
    "This is no bearing of a KrakenSDR: {what}.",
    'Send the text of its DOA_value.html, written with the output format "Kraken App".',
  ],
  bearing_time_impossible: ["The bearing's time is in the future or more than a day ago.", "Set the clock of whatever sent it."],
  which_emitter: ["The search has {emitters} emitters, and none of them is named.", "Name the emitter."],
  taken_earlier: ["It was taken {age_s} before it arrived."],
  import_remark: [
    "{about?place_replaced=The place named replaces the one in|altitude_unknown=0 m AMSL is noted, as no altitude stands in|bearings_stand=The place or antenna named changes no bearing in} {file}.",
  ],
  other_frequency: ["The file {file} was recorded at {recorded_hz}; the mission looks for {wanted_hz}."],
  sweep_incomplete: [
    "Of this sweep these values are unknown: {unknown?bearing=bearing|sigma=sigma|quality=quality|altitude=altitude|drift=drift}.",
    "Take the sweep again.",
  ],
  quality_too_low: ["The quality {quality:2} is below {wanted:2}.", "Take the sweep again."],
  unheard_for_long: [
    "It was not heard from the last {places|place|places}; the others come first until it is heard.",
    "Set the order again to look for it first all the same.",
  ],
  unclear_for_long: [
    "Its bearings have contradicted each other for {places|place|places}; the others come first until they agree.",
    "Look at its bearings and leave out a wrong one, or set the order again.",
  ],
  first_for_long: [
    "{places|place was|places were} chosen for it first and it is not localized; the others come first now.",
    "Set the order again to look for it first all the same.",
  ],
  frequency_shared: [
    "Two emitters send at {frequency_hz}, and not both are tags: no receiver can tell them apart.",
    "Look for one of them at a time; tags at one frequency are distinguished by their periods.",
  ],
  frequencies_too_near: [
    "Emitters at {first_hz} and {second_hz} are so near to each other that the receiver hears each of them on both channels.",
    "From {needed_hz} on they are distinguished. Give tags nearer than that one frequency and their periods, and look for other emitters one at a time.",
  ],
  too_many_rhythms: [
    "More than {most} tags send at {frequency_hz}: too many of their pulses fall together.",
    "Look for {most} of them at a time.",
  ],
  rhythms_too_alike: [
    "At {frequency_hz} one tag sends every {first_s:3} and another every {second_s:3}: their rhythms are too much alike.",
    "Tags that stray as much are distinguished when their periods differ by {needed_s:3} or more. Look for one of them at a time, or state a smaller jitter if theirs is.",
  ],
  database_silent: [
    "The database does not answer: {detail}.",
    "Check that it is running, and that its disk has room and can be written; what happens meanwhile is kept in the spool on the disk.",
  ],
  database_slow: ["The database's last answer took {answer_s:1}.", "Look at its load and its disk."],
  machine_busy: [
    "The server's machine is so busy that the database's answers come late.",
    "End what else runs on this machine; what happens meanwhile is kept in the spool on the disk.",
  ],
  database_taken: [
    "Something else is writing to the database's file.",
    "This passes by itself, as when a bundle is brought in; else end the other program. What happens meanwhile is kept in the spool on the disk.",
  ],
  disk_busy: [
    "The disk is so slow that the database's answers come late.",
    "End what else uses this disk; what happens meanwhile is kept in the spool on it.",
  ],
  disk_low: ["Only {free_bytes} are left on the disk.", "Free some space."],
  stock_full: [
    "There is no room for it: at most {most} {what?overlays=overlays|recordings=raw sweeps of recordings} and {most_bytes} of them are kept.",
    "{what?overlays=Delete overlays that are not needed, or raise CROSSFIX_OVERLAYS_MAX and CROSSFIX_OVERLAYS_MAX_BYTES|recordings=Let raw sweeps of old missions be taken (crossfix thin), or raise CROSSFIX_RECORDINGS_MAX_SWEEPS and CROSSFIX_RECORDINGS_MAX_BYTES}.",
  ],
  nothing_stores: [
    "The database takes nothing ({database}) and the spool cannot be written ({spool}).",
    "Free space on the disk, and bring the database back.",
  ],
  fact_unfit: ["{by?journal=This makes no sense and cannot be stored|database=The database refuses this}: {detail}."],
  written_elsewhere: [
    "Event {seq} of mission {mission_id} does not follow what is stored: another server writes to it.",
    "Let only one server use this database.",
  ],
  mission_damaged: [
    "What is stored of mission {mission_id} is damaged and cannot be read: {detail}.",
    "The other missions are not touched by that; a backup may hold this one whole. It can be deleted in the list.",
  ],
  database_unfit: [
    "The database {database} cannot be used: {detail}.",
    "Check --data-dir and CROSSFIX_DATABASE_URL, and that the disk can be written and has room.",
  ],
  database_later: [
    "A later Crossfix has written the database {database} (schema {revision}).",
    "Update this one, or restore a backup from before the update.",
  ],
  another_server: ["Another server uses {path}.", "Stop it, or start this one with another --data-dir."],
  foreign_spool: ["What lies at {path} is not a journal spool.", "Move it away and start again."],
  not_terrain: [
    "The file is neither a GeoTIFF nor a PMTiles archive.",
    "Upload a GeoTIFF of heights (Copernicus GLO-30, SRTM) or a PMTiles archive of Terrarium tiles.",
  ],
  geotiff_unusable: [
    "The GeoTIFF cannot be used as terrain: {fault?damaged=it is damaged or cut off|big_endian=it is written in big-endian order|sample_type=its values are neither 16-bit integers nor 32-bit floats|several_bands=it has more than one band|too_many_pixels=it has more than 40 million pixels|too_large_tiles=its tiles are larger than 4096 pixels|no_place=it does not say where on earth it lies|rotated=its rows do not run from west to east|off_earth=its corners are not on the earth|too_coarse=its pixels are larger than a kilometre|ellipsoid=its heights are above the ellipsoid, not above mean sea level|feet=its heights are in feet|no_heights=it holds no height}.",
    "{fault?damaged=Copy or download the whole file again.|too_many_pixels=Cut out the part that you fly in, for example with `gdal_translate -projwin`.|ellipsoid=Use heights above the geoid (EGM96 or EGM2008).|no_heights=Use a file that covers the area.|*=Convert it with `gdalwarp -t_srs EPSG:4326 -ot Float32 -co COMPRESS=DEFLATE`.}",
  ],
  other_coordinate_system: [
    "The GeoTIFF is not in longitude and latitude (EPSG:4326){epsg?none=|*=, but in another system}.",
    "Convert it with `gdalwarp -t_srs EPSG:4326`.",
  ],
  terrarium_unusable: [
    "The PMTiles archive cannot be used as terrain: {fault?vector=it holds vector tiles|picture_type=its tiles are neither PNG nor lossless WebP|tile_size=its tiles are not squares of 256 or 512 pixels|damaged=a tile cannot be read|no_heights=its tiles hold no heights in the Terrarium encoding}.",
    "Upload an archive of Terrarium tiles (height = red * 256 + green + blue / 256 - 32768).",
  ],
  heights_implausible: [
    "The file's heights go from {lowest_m} to {highest_m}, which is nowhere on earth.",
    "Check that it holds heights in metres, and names its value for no data.",
  ],
  terrain_too_large: ["The file is larger than {most_bytes}.", "Cut out the part that you fly in."],
  terrain_label_damaged: ["{file}: this terrain can no longer be read.", "Delete it and upload it again."],
  no_terrain: [
    "No terrain: the ground is taken to be level with home.",
    "Upload terrain of the area, or make sure that nothing in it rises towards the flight altitude.",
  ],
  terrain_covers: ["Terrain covers the fence, a height every {spacing_m}; the highest ground is {highest_above_home_m} above home."],
  terrain_partly: [
    "Terrain covers only {known_percent} of the fence; ways over the rest are refused.",
    "Upload terrain for all of it, or remove it.",
  ],
  home_height_differs: [
    "The terrain has home at {terrain_m:0} above sea level, the autopilot at {autopilot_m:0}; each way keeps clear of the ground by either.",
    "Wait for a better GPS fix and arm again at the take-off place, or check that the terrain's heights are metres above mean sea level.",
  ],
  ground_not_kept: ["The terrain could not be stored with the mission: {detail}.", "Make room on the disk, then start again."],
  whole_turn: [
    "A whole turn: {because?first=nothing was heard here or elsewhere before|again=the sweep before gave no bearing|unsure=the bearings so far contradict each other|wide=the emitter may be in almost any direction|several=several emitters are listened to|pulsed=a tag's pulses need every heading|second_place=the first places of this search hear all directions}.",
  ],
  sector_expected: ["A sector of {width_deg}: it holds {share_percent} of the directions expected from here, and a margin."],
  maximum_seen: [
    "Stopped after {turned_deg}: the maximum lies {inside_deg} within it, and another direction has a probability of {elsewhere_percent}.",
  ],
  whole_circle_seen: ["Stopped after the whole circle."],
  maximum_at_edge: ["Turned {by_deg} further: the maximum lay at the sector's {edge?beginning=beginning|end=end}."],
  quality_poor: ["Turned {by_deg} further: what was heard resembled the antenna's pattern by {quality:2} only."],
  elsewhere_possible: ["Turned {by_deg} further: a direction not yet heard had a probability of {elsewhere_percent}."],
  bearing_uncertain: ["Turned {by_deg} further: the bearing was still uncertain by {sigma_deg:1}."],
  nothing_found_yet: ["Turned {by_deg} further: what was heard gave no bearing yet."],
  turns_here: [
    "It turns here: {because?first=all directions are heard once before it flies on without turning|told_nothing=the way here told little of the direction|contradicts=what it heard contradicts what was believed}.",
  ],
  way_told_enough: [
    "No turn here: by what was heard on the way here, the emitter is {likelier:1} times likelier at the estimate than in a direction at random.",
  ],
  never_stop_needs: [
    "Never stopping to turn {what?one_emitter=is for one emitter: the nose swings about one direction|carrier=is for a carrier: a tag's pulses are too few on the way|still=is for an emitter that stands still|joint=needs joint bearing errors|swings=needs listening on the way and the nose's swings there|rollouts=needs the planner that simulates flights}.",
    "{what?one_emitter=Turn it off, or look for one emitter|carrier=Turn it off|still=Turn it off|joint=Choose joint errors, or turn it off|swings=Turn both on, or turn this off|rollouts=Choose that planner, or turn this off}.",
  ],
  neither_way_nor_barrier: ["{parts|part is|parts are} left out: nothing says whether it is a road, a path or a barrier."],
  far_from_search: ["{parts|part is|parts are} left out, further than {most_m} from the search area."],
  no_ways_in_file: [
    "The file holds no road, path or barrier that could be told; {parts|other part|other parts} it has.",
    'Give each line or area a property "kind" that is "road", "path" or "barrier", or export them from OpenStreetMap with their tags.',
  ],
  ways_too_far: [
    "No road, path or barrier of the file lies within {most_m} of the search area: the nearest is at {nearest_m}.",
    "Use the file that belongs to this search. In GeoJSON longitude comes first.",
  ],
  ways_too_many: [
    "The roads, paths and barriers near the search area have {positions} positions; {most} are the most.",
    "Cut the file to the search and the ways there, or leave out what is not needed.",
  ],
  no_road_near: [
    "No road leads away from where you stand: the nearest one known is {nearest_m} away, and your car is looked for within {most_m}, on your side of what cannot be crossed.",
    "Say where the car stands, go on foot, or upload ways with the missing road.",
  ],
  no_way_leads_there: [
    "No way leads there: {places|place|places} to listen from, and none that can be reached from where you stand {on_roads?true=by the roads that are known|false=without crossing what cannot be crossed}.",
    "Start elsewhere, or upload ways with the missing road, bridge or gate.",
  ],
  file_too_heavy: [
    "The file was not read to its end: {limit?time=it took too long|memory=it took too much memory|depth=it is nested too deep|process=the process that read it ended} (a file may take {most_s} and {most_bytes} of memory). Nothing of it was kept.",
    "Simplify it or divide it, and upload the parts.",
  ],
  readers_busy: ["{waiting|other file is|other files are} waiting to be read.", "Wait a moment, then upload it again."],
  disk_full: ["The disk is full. Nothing of the file was kept.", "Delete maps, overlays or other files, then upload it again."],
  mission_too_heavy: [
    "This was not worked out: {limit?time=it took too long|memory=it took too much memory|depth=it is nested too deep|process=the process that worked on it ended|busy=too much else is worked on} (a mission may take {most_s} and {most_bytes} of memory). Nothing is lost, and the flight goes on.",
    "{limit?busy=Wait a moment, then ask again.|*=Ask for less of it: one format, or an earlier belief.}",
  ],
  told_before: ["{text}", "{remedy}"],
  no_usable_bearing: ["{again?true=The sweep is taken again|false=No usable bearing here}: {because}", "{because!remedy}"],
  not_localized: ["Not localized. {because} {not_yet}"],
  places_used_up: ["{places|place was|places were} used, as many as the mission allows."],
  no_longer_localized: ["No longer localized since a bearing was excluded. {not_yet}"],
  receiver_trouble: ["Receiver: {because}", "{because!remedy}"],
  preflight_failed: ["Preflight: {because}", "{because!remedy}"],
  interrupted: ["Interrupted: {because?later_mission=a mission started later is the one in the air|unreadable=it can no longer be read}."],
  ordered_again_later: ["{because}", "It is ordered again when the vehicle is heard."],
  not_done: [
    "{order?hold=The hold|return=The return|land=The landing|abort=The abort} is not done: {because} {next_way?hold=Holding is tried|return=The return is tried|land=Landing where it is is tried} in {next_in_s}.",
    "Another order takes its place. The pilot can take over at any time.",
  ],
  instead: [
    "{order?hold=The hold|return=The return|land=The landing|abort=The abort} could not be done, so the vehicle {way?hold=holds|return=returns|land=lands where it is}. {because}",
    "Look at the vehicle. Another order takes its place.",
  ],
  autopilot_flies_home: ["The autopilot flies home by its own way, which knows no no-fly zones: {because}", "Watch it; hold stops it."],
};
