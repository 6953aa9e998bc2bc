# One way to declare Debian packages, so that each has its licence, its changelog and its maintainer scripts. The files of
# a package are those installed with its name as COMPONENT. Include CPack after the last of them.

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME beckon)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "") # each package's own
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(beckon_package_version ${CPACK_PACKAGE_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})
set(CPACK_PACKAGE_DIRECTORY ${PROJECT_BINARY_DIR}/packages)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SECTION science)
set(BECKON_MAINTAINER "The Beckon authors <beckon@beckon.invalid>" CACHE STRING "Who answers for the Debian packages")
set(CPACK_DEBIAN_PACKAGE_MAINTAINER ${BECKON_MAINTAINER})
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_STRIP_FILES ON)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE
  WORLD_READ WORLD_EXECUTE)
set(CPACK_COMPONENTS_ALL "")

# What Debian asks every package for, made once.
set(package_files ${PROJECT_BINARY_DIR}/deploy)
file(READ ${PROJECT_SOURCE_DIR}/LICENSE licence)
string(REGEX REPLACE "^[^\n]*\n\n[^\n]*\n\n" "" licence "${licence}") # its title and copyright stand elsewhere
string(STRIP "${licence}" licence)
string(REPLACE "\n\n" "\n.\n" licence "${licence}")
string(REPLACE "\n" "\n " licence " ${licence}")
configure_file(${PROJECT_SOURCE_DIR}/deploy/packages/copyright.in ${package_files}/copyright @ONLY)
configure_file(${PROJECT_SOURCE_DIR}/deploy/packages/changelog ${package_files}/changelog COPYONLY)
execute_process(COMMAND gzip -9nc ${package_files}/changelog OUTPUT_FILE ${package_files}/changelog.Debian.gz
  COMMAND_ERROR_IS_FATAL ANY)

# beckon_package(NAME SUMMARY TEXT DESCRIPTION TEXT [DATA_ONLY] [DEPENDS PACKAGES] [RECOMMENDS PACKAGES] [SUGGESTS PACKAGES]
#   [CONFFILES PATHS] [SCRIPTS FILES: maintainer scripts, by their names])
macro(beckon_package name)
  cmake_parse_arguments(ARG DATA_ONLY "SUMMARY;DESCRIPTION" "DEPENDS;RECOMMENDS;SUGGESTS;CONFFILES;SCRIPTS" ${ARGN})
  list(APPEND CPACK_COMPONENTS_ALL ${name})
  string(TOUPPER ${name} NAME)
  set(CPACK_DEBIAN_${NAME}_PACKAGE_NAME ${name})
  set(CPACK_DEBIAN_${NAME}_DESCRIPTION "${ARG_SUMMARY}\n${ARG_DESCRIPTION}")
  if(ARG_DATA_ONLY)
    set(CPACK_DEBIAN_${NAME}_PACKAGE_ARCHITECTURE all)
    set(CPACK_DEBIAN_${NAME}_PACKAGE_SHLIBDEPS OFF)
  endif()
  list(JOIN ARG_DEPENDS ", " CPACK_DEBIAN_${NAME}_PACKAGE_DEPENDS)
  list(JOIN ARG_RECOMMENDS ", " CPACK_DEBIAN_${NAME}_PACKAGE_RECOMMENDS)
  list(JOIN ARG_SUGGESTS ", " CPACK_DEBIAN_${NAME}_PACKAGE_SUGGESTS)
  set(control ${ARG_SCRIPTS})
  if(ARG_CONFFILES)
    list(JOIN ARG_CONFFILES "\n" conffiles)
    file(WRITE ${package_files}/${name}/conffiles "${conffiles}\n")
    list(APPEND control ${package_files}/${name}/conffiles)
  endif()
  set(CPACK_DEBIAN_${NAME}_PACKAGE_CONTROL_EXTRA "${control}")
  install(FILES ${package_files}/copyright ${package_files}/changelog.Debian.gz
    DESTINATION ${CMAKE_INSTALL_DATADIR}/doc/${name} COMPONENT ${name} EXCLUDE_FROM_ALL)
endmacro()

# beckon_service_package(SERVICE ...): the package beckon-SERVICE of a program, with its settings (deploy/settings/SERVICE.*),
# its place in beckon.target and what its unit is allowed (deploy/systemd/beckon@SERVICE.service.d); else as beckon_package.
macro(beckon_service_package service)
  set(unit beckon@${service}.service)
  set(scripts ${package_files}/beckon-${service})
  foreach(script postinst prerm postrm)
    configure_file(${CMAKE_CURRENT_SOURCE_DIR}/packages/service/${script}.in ${scripts}/${script} @ONLY)
  endforeach()
  configure_file(${CMAKE_CURRENT_SOURCE_DIR}/packages/service/lintian-overrides.in ${scripts}/lintian-overrides @ONLY)
  file(MAKE_DIRECTORY ${scripts}/wants)
  file(CREATE_LINK ../beckon@.service ${scripts}/wants/${unit} SYMBOLIC)
  file(GLOB settings CONFIGURE_DEPENDS settings/${service}.*)
  list(TRANSFORM settings REPLACE ".*/" "/etc/beckon/" OUTPUT_VARIABLE conffiles)
  beckon_package(beckon-${service} ${ARGN} CONFFILES ${conffiles} SCRIPTS ${scripts}/postinst ${scripts}/prerm ${scripts}/postrm)
  install(FILES ${settings} DESTINATION /etc/beckon COMPONENT beckon-${service} EXCLUDE_FROM_ALL)
  install(FILES ${scripts}/wants/${unit} DESTINATION lib/systemd/system/beckon.target.wants COMPONENT beckon-${service}
    EXCLUDE_FROM_ALL)
  install(FILES ${scripts}/lintian-overrides DESTINATION ${CMAKE_INSTALL_DATADIR}/lintian/overrides
    RENAME beckon-${service} COMPONENT beckon-${service} EXCLUDE_FROM_ALL)
  if(EXISTS ${CMAKE_CURRENT_SOURCE_DIR}/systemd/${unit}.d)
    install(DIRECTORY systemd/${unit}.d DESTINATION lib/systemd/system COMPONENT beckon-${service} EXCLUDE_FROM_ALL)
  endif()
endmacro()
