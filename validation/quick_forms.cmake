# Short forms (at most 20 s each) of validation's programs and scripts, label `validation`, and the test that none is forgotten.
if(NOT FISHERHILL_TESTS OR NOT Python3_Interpreter_FOUND)
  return()
endif()
set(quick ${PROJECT_BINARY_DIR}/quick_validation)
file(MAKE_DIRECTORY ${quick})
function(fisherhill_quick name)
  add_test(NAME Quick.${name} COMMAND ${ARGN} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
  set_tests_properties(Quick.${name} PROPERTIES LABELS validation TIMEOUT 120)
endfunction()
set(python ${Python3_EXECUTABLE})
set(program $<TARGET_FILE:fisherhill>)

fisherhill_quick(MakeElbow8 sh -c "$<TARGET_FILE:make_elbow8> ${quick} && cmp ${quick}/elbow8.osim models/elbow8.osim && \
cmp ${quick}/elbow8_passive.osim models/elbow8_passive.osim")
fisherhill_quick(SkeletonModels skeleton_models models/elbow8.osim models/ankle_ta.osim)
fisherhill_quick(RandomGeodesics random_geodesics 1000)
fisherhill_quick(EveryModel ${python} validation/muscles/every_model.py ${program} models)
set_tests_properties(Quick.EveryModel PROPERTIES PASS_REGULAR_EXPRESSION "ankle_ta . ok ")
fisherhill_quick(SameNumbers ${python} validation/same_numbers ${program} ${program} rk4 curl_fast)
fisherhill_quick(CalibrationBasins sh -c
  "rm -rf ${quick}/basins && ${python} validation/calibration_basins.py ${PROJECT_BINARY_DIR} ${quick}/basins 1 1")
set_tests_properties(Quick.CalibrationBasins PROPERTIES PASS_REGULAR_EXPRESSION "training 1, training and held out 1, intervals 1 of 1")
# one set of one robot: made, looked at, scored
fisherhill_quick(RobotsSuite sh -c
  "rm -rf ${quick}/robots && validation/discovery/robots_suite ${PROJECT_BINARY_DIR} ${quick}/robots quick && \
test -s ${quick}/robots/double-pendulum/verdicts/s41000/verdict.json")
set_tests_properties(Quick.RobotsSuite PROPERTIES TIMEOUT 300)
# one short set of two joints, one of a torque: made, looked at, scored
function(fisherhill_quick_family name family seed)
  fisherhill_quick(${name} sh -c "rm -rf ${quick}/${family} && ${python} validation/discovery/families/make_sets.py \
--build ${PROJECT_BINARY_DIR} --family ${family} --seed ${seed} --sets 1 --seconds 2 --jobs 1 ${quick}/${family}")
  set_tests_properties(Quick.${name} PROPERTIES PASS_REGULAR_EXPRESSION "truth inside the class, of those detected . 1 of 1")
endfunction()
fisherhill_quick_family(TwoJoints shoulder 99)
fisherhill_quick_family(Torque torque 101)
fisherhill_quick(ScaledTwins ${python} validation/discovery/twins/scaled_twins.py --build ${PROJECT_BINARY_DIR}
  --only slide:const --only pendulum:drag ${quick}/twins)
set_tests_properties(Quick.ScaledTwins PROPERTIES PASS_REGULAR_EXPRESSION "2 of 2 pairs have the same verdict; the hidden effect is in the class of 2")
fisherhill_quick(OwnEffects ${python} validation/discovery/own/own_effects.py --build ${PROJECT_BINARY_DIR} --sets 1 ${quick}/own)
set_tests_properties(Quick.OwnEffects PROPERTIES PASS_REGULAR_EXPRESSION "own: 1 of 1 first")
fisherhill_quick(HiddenDrives ${python} validation/discovery/drives/hidden_drives.py --build ${PROJECT_BINARY_DIR}
  --only pendulum:delay --only slide:none --sets 1 ${quick}/drives)
set_tests_properties(Quick.HiddenDrives PROPERTIES PASS_REGULAR_EXPRESSION "Of 1 hidden effects 1 are in the class .*of 1 sets with nothing hidden 0 have a name")
fisherhill_quick(HiddenChains ${python} validation/discovery/chains/hidden_chains.py --build ${PROJECT_BINARY_DIR} --sets 1 ${quick}/chains)
set_tests_properties(Quick.HiddenChains PROPERTIES PASS_REGULAR_EXPRESSION "Of 1 hidden effects 1 are in the class")
find_program(mpirun mpirun)
if(mpirun AND TARGET fisherhill-mpi)
  fisherhill_quick(KillRanks validation/robustness/kill_ranks ${program} 1 1)
  fisherhill_quick(InterruptStart validation/robustness/interrupt_start ${program} 2 1)
endif()
add_test(NAME Quick.NoScriptOfValidationIsForgotten
  COMMAND ${python} ${CMAKE_CURRENT_SOURCE_DIR}/check_watched.py ${PROJECT_BINARY_DIR})
set_tests_properties(Quick.NoScriptOfValidationIsForgotten PROPERTIES LABELS validation)
