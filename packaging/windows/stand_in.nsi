; A program that does nothing for six seconds: it stands in for busk.exe where the installer is tried.
Unicode true
Target amd64-unicode
RequestExecutionLevel user
SilentInstall silent
Name "stand-in"
OutFile "${OUT}"
Section
  Sleep 6000
SectionEnd
