# Who answers for a package is who makes it, and says so as Debian's tools have it.
if(NOT DEFINED ENV{DEBFULLNAME} OR NOT DEFINED ENV{DEBEMAIL})
  message(FATAL_ERROR "set DEBFULLNAME and DEBEMAIL: a package names who answers for it")
endif()
set(CPACK_DEBIAN_PACKAGE_MAINTAINER "$ENV{DEBFULLNAME} <$ENV{DEBEMAIL}>")
