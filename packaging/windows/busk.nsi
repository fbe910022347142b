; The installer of Busk for Windows: for one user, with no administrator. packaging/windows/installer.py compiles it:
;   VERSION, PAYLOAD (the folder with busk.exe), OUT, ICON, PROJECT_ICON, LICENCE; TARGET only where it is not the usual one.
; It writes to its folder, the start menu and HKEY_CURRENT_USER alone, and never to HKCU\Software\Busk: there the
; program keeps what its user chose.

Unicode true
!ifdef TARGET
  Target ${TARGET}
!endif
SetCompressor /SOLID lzma
SetCompressorDictSize 64
RequestExecutionLevel user
ManifestDPIAware true
ManifestSupportedOS Win10

!include MUI2.nsh
!include LogicLib.nsh
!include WinVer.nsh
!include Sections.nsh
!include x64.nsh

!define LISTED "Software\Microsoft\Windows\CurrentVersion\Uninstall\Busk"
!define APP_PATHS "Software\Microsoft\Windows\CurrentVersion\App Paths"
!define CLASSES "Software\Classes"
!define KIND "Busk.Project"

Name "Busk ${VERSION}"
OutFile "${OUT}"
InstallDir "$LOCALAPPDATA\Programs\Busk"
InstallDirRegKey HKCU "${LISTED}" "InstallLocation"
BrandingText "Busk ${VERSION}"

!define MUI_ICON "${ICON}"
!define MUI_UNICON "${ICON}"
!define MUI_ABORTWARNING
!define MUI_FINISHPAGE_RUN "$INSTDIR\buskw.exe"
!define MUI_COMPONENTSPAGE_SMALLDESC

!insertmacro MUI_PAGE_LICENSE "${LICENCE}"
!insertmacro MUI_PAGE_COMPONENTS
!define MUI_PAGE_CUSTOMFUNCTION_LEAVE RefuseForeignFolder
!insertmacro MUI_PAGE_DIRECTORY
!insertmacro MUI_PAGE_INSTFILES
!insertmacro MUI_PAGE_FINISH
!insertmacro MUI_UNPAGE_CONFIRM
!insertmacro MUI_UNPAGE_INSTFILES
!insertmacro MUI_LANGUAGE "English"
!insertmacro MUI_LANGUAGE "Japanese"
!include words.nsh

VIProductVersion "${VERSION}.0"
!macro DescribeIn language
  VIAddVersionKey /LANG=${language} "ProductName" "Busk"
  VIAddVersionKey /LANG=${language} "ProductVersion" "${VERSION}"
  VIAddVersionKey /LANG=${language} "FileVersion" "${VERSION}"
  VIAddVersionKey /LANG=${language} "FileDescription" "Busk ${VERSION} Setup"
  VIAddVersionKey /LANG=${language} "LegalCopyright" "Apache License 2.0"
!macroend
!insertmacro DescribeIn ${LANG_ENGLISH}
!insertmacro DescribeIn ${LANG_JAPANESE}

; Says why nothing is done, and ends: code 2, in silence too.
!macro Refuse sentence
  MessageBox MB_OK|MB_ICONEXCLAMATION "${sentence}" /SD IDOK
  SetErrorLevel 2
  Quit
!macroend

; A program that runs lets nobody write to its file. Whoever closes Busk may go on, in silence it ends with code 2.
!macro RefuseWhileRunning file
  ${Do}
    ${IfNot} ${FileExists} "$INSTDIR\${file}"
      ${Break}
    ${EndIf}
    ClearErrors
    FileOpen $0 "$INSTDIR\${file}" a
    ${IfNot} ${Errors}
      FileClose $0
      ${Break}
    ${EndIf}
    ${If} ${Cmd} `MessageBox MB_RETRYCANCEL|MB_ICONEXCLAMATION "$(IS_RUNNING)" /SD IDCANCEL IDCANCEL`
      SetErrorLevel 2
      Quit
    ${EndIf}
  ${Loop}
!macroend

; What an installer may have put into the folder, and nothing beside it.
!macro RemoveProgram
  RMDir /r "$INSTDIR\_internal"
  Delete "$INSTDIR\busk.exe"
  Delete "$INSTDIR\buskw.exe"
  Delete "$INSTDIR\busk-project.ico"
!macroend

!macro TellTheSystem
  System::Call 'shell32::SHChangeNotify(i 0x08000000, i 0, p 0, p 0)'
!macroend

; _internal is removed before a newer version comes: it must be Busk's own.
Function FolderIsForeign
  StrCpy $R0 ""
  ${IfNot} ${FileExists} "$INSTDIR\busk.exe"
    FindFirst $0 $1 "$INSTDIR\*"
    ${DoWhile} $1 != ""
      ${If} $1 != "."
      ${AndIf} $1 != ".."
        StrCpy $R0 $1
      ${EndIf}
      FindNext $0 $1
    ${Loop}
    FindClose $0
  ${EndIf}
FunctionEnd

Function RefuseForeignFolder
  Call FolderIsForeign
  ${If} $R0 != ""
    MessageBox MB_OK|MB_ICONEXCLAMATION "$(FOREIGN_FOLDER)"
    Abort
  ${EndIf}
FunctionEnd

Section "Busk" program
  SectionIn RO
  Call FolderIsForeign
  ${If} $R0 != ""
    !insertmacro Refuse "$(FOREIGN_FOLDER)"
  ${EndIf}
  !insertmacro RefuseWhileRunning busk.exe
  !insertmacro RefuseWhileRunning buskw.exe
  !insertmacro RemoveProgram
  SetOutPath "$INSTDIR"
  File /r "${PAYLOAD}\*"
  File "/oname=busk-project.ico" "${PROJECT_ICON}"
  WriteUninstaller "$INSTDIR\uninstall.exe"
  CreateShortCut "$SMPROGRAMS\Busk.lnk" "$INSTDIR\buskw.exe"

  WriteRegStr HKCU "${LISTED}" "DisplayName" "Busk"
  WriteRegStr HKCU "${LISTED}" "DisplayVersion" "${VERSION}"
  WriteRegStr HKCU "${LISTED}" "DisplayIcon" "$INSTDIR\buskw.exe"
  WriteRegStr HKCU "${LISTED}" "Publisher" "Busk"
  WriteRegStr HKCU "${LISTED}" "InstallLocation" "$INSTDIR"
  WriteRegStr HKCU "${LISTED}" "UninstallString" '"$INSTDIR\uninstall.exe"'
  WriteRegStr HKCU "${LISTED}" "QuietUninstallString" '"$INSTDIR\uninstall.exe" /S'
  WriteRegDWORD HKCU "${LISTED}" "NoModify" 1
  WriteRegDWORD HKCU "${LISTED}" "NoRepair" 1
  SectionGetSize ${program} $0
  WriteRegDWORD HKCU "${LISTED}" "EstimatedSize" $0

  ; "busk" in Win+R and in "start busk". The PATH is left alone: plain NSIS would cut a long one off.
  WriteRegStr HKCU "${APP_PATHS}\busk.exe" "" "$INSTDIR\busk.exe"
  WriteRegStr HKCU "${APP_PATHS}\buskw.exe" "" "$INSTDIR\buskw.exe"
  WriteRegStr HKCU "${CLASSES}\Applications\buskw.exe" "FriendlyAppName" "Busk"
  WriteRegStr HKCU "${CLASSES}\Applications\buskw.exe\shell\open\command" "" '"$INSTDIR\buskw.exe" "%1"'
  !macro Opens ending
    WriteRegStr HKCU "${CLASSES}\Applications\buskw.exe\SupportedTypes" "${ending}" ""
  !macroend
  !insertmacro Opens ".busk"
  !insertmacro Opens ".ply"
  !insertmacro Opens ".obj"
  !insertmacro Opens ".stl"
  !insertmacro Opens ".off"
  !insertmacro Opens ".glb"
  !insertmacro Opens ".gltf"
  !insertmacro Opens ".vtp"
SectionEnd

Section "$(FILE_TYPE)" file_type
  WriteRegStr HKCU "${CLASSES}\${KIND}" "" "$(PROJECT)"
  WriteRegStr HKCU "${CLASSES}\${KIND}\DefaultIcon" "" "$INSTDIR\busk-project.ico"
  WriteRegStr HKCU "${CLASSES}\${KIND}\shell\open\command" "" '"$INSTDIR\buskw.exe" "%1"'
  WriteRegStr HKCU "${CLASSES}\.busk\OpenWithProgids" "${KIND}" ""
  ; What somebody else has made of the ending stays; Busk is then among what it can be opened with.
  ReadRegStr $0 HKCU "${CLASSES}\.busk" ""
  ${If} $0 == ""
    WriteRegStr HKCU "${CLASSES}\.busk" "" "${KIND}"
  ${EndIf}
  !insertmacro TellTheSystem
SectionEnd

Section /o "$(DESKTOP_LINK)" desktop_link
  CreateShortCut "$DESKTOP\Busk.lnk" "$INSTDIR\buskw.exe"
SectionEnd

; An upgrade asks for the file type as it was answered before; the first time it is ticked.
Section "-remember" remember
  ${If} ${SectionIsSelected} ${file_type}
    WriteRegDWORD HKCU "${LISTED}" "FileType" 1
  ${Else}
    WriteRegDWORD HKCU "${LISTED}" "FileType" 0
  ${EndIf}
SectionEnd

; Below the sections, whose numbers it asks for.
Function .onInit
  ${IfNot} ${AtLeastWin10}
    !insertmacro Refuse "$(TOO_OLD)"
  ${EndIf}
  ${IfNot} ${IsNativeAMD64}
  ${AndIfNot} ${IsNativeARM64} ; it runs what is made for the other
    !insertmacro Refuse "$(TOO_OLD)"
  ${EndIf}
  ClearErrors
  ReadRegDWORD $0 HKCU "${LISTED}" "FileType"
  ${IfNot} ${Errors}
  ${AndIf} $0 == 0
    !insertmacro UnselectSection ${file_type}
  ${EndIf}
FunctionEnd

!insertmacro MUI_FUNCTION_DESCRIPTION_BEGIN
  !insertmacro MUI_DESCRIPTION_TEXT ${program} "$(ABOUT_PROGRAM)"
  !insertmacro MUI_DESCRIPTION_TEXT ${file_type} "$(ABOUT_FILE_TYPE)"
  !insertmacro MUI_DESCRIPTION_TEXT ${desktop_link} "$(ABOUT_DESKTOP_LINK)"
!insertmacro MUI_FUNCTION_DESCRIPTION_END

Section "Uninstall"
  !insertmacro RefuseWhileRunning busk.exe
  !insertmacro RefuseWhileRunning buskw.exe
  !insertmacro RemoveProgram
  Delete "$INSTDIR\uninstall.exe"
  RMDir "$INSTDIR" ; only if nothing else lies there
  Delete "$SMPROGRAMS\Busk.lnk"
  Delete "$DESKTOP\Busk.lnk"
  DeleteRegKey HKCU "${LISTED}"
  DeleteRegKey HKCU "${APP_PATHS}\busk.exe"
  DeleteRegKey HKCU "${APP_PATHS}\buskw.exe"
  DeleteRegKey HKCU "${CLASSES}\Applications\buskw.exe"
  DeleteRegKey HKCU "${CLASSES}\${KIND}"
  DeleteRegValue HKCU "${CLASSES}\.busk\OpenWithProgids" "${KIND}"
  DeleteRegKey /ifempty HKCU "${CLASSES}\.busk\OpenWithProgids"
  ReadRegStr $0 HKCU "${CLASSES}\.busk" ""
  ${If} $0 == "${KIND}"
    DeleteRegValue HKCU "${CLASSES}\.busk" ""
  ${EndIf}
  DeleteRegKey /ifempty HKCU "${CLASSES}\.busk"
  !insertmacro TellTheSystem
SectionEnd
