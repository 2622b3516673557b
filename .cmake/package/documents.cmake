# The documents that a Debian package holds, written as it is installed. In: source, gzip, name, version, folder.
file(READ ${source}/shared/drawing/page/bundle/LICENSES bundle_licenses)
# A text's lines are indented there, and an empty one is a point.
string(REGEX REPLACE "\n" "\n " bundle_licenses " ${bundle_licenses}")
string(REGEX REPLACE "\n *\n" "\n .\n" bundle_licenses "${bundle_licenses}")
string(REGEX REPLACE "\n *\n" "\n .\n" bundle_licenses "${bundle_licenses}")
configure_file(${source}/.cmake/package/copyright.in ${folder}/copyright @ONLY)
# Only a package has a history of its own, and somebody who answers for it.
if(DEFINED ENV{DEBFULLNAME} AND DEFINED ENV{DEBEMAIL})
  set(maintainer "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
  file(TIMESTAMP ${source}/CHANGELOG.md changed "%a, %d %b %Y %H:%M:%S +0000" UTC)
  configure_file(${source}/.cmake/package/changelog.in ${folder}/changelog.Debian @ONLY)
  execute_process(COMMAND ${gzip} -9nf ${folder}/changelog.Debian COMMAND_ERROR_IS_FATAL ANY)
endif()
